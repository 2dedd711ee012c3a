// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>
#include "landmarks/landmark_type.hpp"
#include "pipeline/engine/plan/planner.hpp"
#include "pipeline/engine/progress_meter.hpp"
#include "pipeline/engine/run/run_state.hpp"
#include "pipeline/engine/runner.hpp"
#include "pipeline/engine/store/artifact_store.hpp"
#include "pipeline/engine/store/scratch_file.hpp"
namespace waymark::pipeline {

/// One run, from plan to result. Stages run in order, the units of a stage in parallel.
/// Each unit changes only its own state, so no lock is needed and results do not depend on the order.
class Run {
 public:
  Run(const Pipeline& pipeline, const RunOptions& options);

  /// Computes size and hash of every input file, in parallel.
  void hash_inputs();
  /// Computes size and hash of the images listed while planning. An unreadable image keeps an empty hash; the
  /// units that need it report the error.
  void hash_images();
  /// Lists all units by running the listing stages. With `fingerprints`, hash_inputs must have returned.
  void make_plan(bool fingerprints);
  void run_stages();

  Plan plan() const { return plan_; }
  RunResult result() const;

 private:
  void collect_input_paths();
  void append_stage(bool fingerprints);
  void take_items(std::size_t stage);
  void check_inputs(std::size_t stage) const;
  void run_stage(std::size_t stage);
  void do_unit(std::size_t stage, std::size_t unit, ProgressMeter& progress);
  bool gathers_nothing(std::size_t stage, std::size_t unit) const;
  bool is_used(const InputFile& image) const;
  bool reuse(std::size_t stage, std::size_t unit);
  void make(std::size_t stage, std::size_t unit, ProgressMeter& progress);
  bool is_offloaded(std::size_t stage, const std::string& port) const;
  ArtifactPtr offload(std::size_t stage, const OutputPort& port, Artifact::Value value);
  void warn_about_missing_inputs(std::size_t stage, std::size_t unit);
  UnitInputs unit_inputs(std::size_t stage, std::size_t unit) const;
  void expect_selected_units() const;
  void release_read(std::size_t stage);
  bool wanted(const Wire& wire) const;
  const Step& step(std::size_t stage) const { return *pipeline_.steps()[stage]; }

  const Pipeline& pipeline_;
  const RunOptions& options_;
  TypeRegistry built_in_types_;  ///< empty if the caller gave types
  const TypeRegistry* types_;
  std::string types_fingerprint_;
  std::optional<ArtifactStore> store_;
  std::vector<std::vector<Wire>> wires_;  ///< per stage
  std::vector<bool> planning_;            ///< per stage: runs while planning
  std::vector<bool> rerun_;               ///< per stage: run again because of --rerun-from
  std::vector<InputFile> inputs_;
  std::vector<std::vector<std::size_t>> stage_inputs_;  ///< indices into inputs_
  Plan plan_;
  Items items_;
  std::vector<InputFile> image_files_;  ///< one per image
  std::vector<UnitState> states_;
  std::vector<double> seconds_;                        ///< per stage
  std::vector<std::shared_ptr<ScratchFile>> scratch_;  ///< per stage
};

}  // namespace waymark::pipeline
