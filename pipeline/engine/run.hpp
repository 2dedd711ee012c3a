// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>
#include "pipeline/engine/artifact_store.hpp"
#include "pipeline/engine/planner.hpp"
#include "pipeline/engine/progress_meter.hpp"
#include "pipeline/engine/run_state.hpp"
#include "pipeline/engine/runner.hpp"
#include "pipeline/engine/scratch_file.hpp"
namespace waymark {

/// One run from plan to result. Stage by stage; the units of a stage run in parallel, each touching its own
/// state only, so no lock is needed and no order shows in the result.
class Run {
 public:
  Run(const Pipeline& pipeline, const RunOptions& options);

  /// Size and hash of every input file, in parallel.
  void hash_inputs();
  /// The same for the images listed while planning. One that cannot be read keeps an empty hash: the units
  /// that need it will say what is wrong, the others go on.
  void hash_images();
  /// Lists all units; runs the listing stages. With `fingerprints`, hash_inputs must have returned.
  void make_plan(bool fingerprints);
  void run_stages();

  Plan plan() const { return plan_; }
  RunResult result() const;

 private:
  void name_inputs();
  void append_stage(bool fingerprints);
  void take_items(std::size_t stage);
  void run_stage(std::size_t stage);
  void do_unit(std::size_t stage, std::size_t unit, ProgressMeter& progress);
  bool gathers_nothing(std::size_t stage, std::size_t unit) const;
  bool reuse(std::size_t stage, std::size_t unit);
  void make(std::size_t stage, std::size_t unit, ProgressMeter& progress);
  bool put_aside(std::size_t stage, const std::string& port) const;
  ArtifactPtr aside(std::size_t stage, const OutputPort& port, Artifact::Value value);
  void warn_of_lost(std::size_t stage, std::size_t unit);
  UnitInputs inputs_of(std::size_t stage, std::size_t unit) const;
  void expect_wanted_unit() const;
  void release_read(std::size_t stage);
  bool wanted(const Wire& wire) const;
  const Step& step(std::size_t stage) const { return *pipeline_.steps()[stage]; }

  const Pipeline& pipeline_;
  const RunOptions& options_;
  std::optional<ArtifactStore> store_;
  std::vector<std::vector<Wire>> wires_;  ///< per stage
  std::vector<bool> planning_;            ///< per stage: runs while planning
  std::vector<bool> anew_;                ///< per stage: --rerun-from reaches it
  std::vector<InputFile> inputs_;
  std::vector<std::vector<std::size_t>> inputs_of_stage_;  ///< indices into inputs_
  Plan plan_;
  Items items_;
  std::vector<InputFile> image_files_;  ///< one per image
  std::vector<UnitState> states_;
  std::vector<double> seconds_;                        ///< per stage
  std::vector<std::shared_ptr<ScratchFile>> scratch_;  ///< per stage
};

}  // namespace waymark
