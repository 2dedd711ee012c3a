// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>
#include <vector>
#include "apps/command.hpp"
#include "apps/make_map.hpp"
#include "apps/stage_options.hpp"
#include "pipeline/engine/pipeline.hpp"
namespace waymark {

/// A command that builds a job from files and a few options of its stages, and runs it as `waymark run`
/// would: the same code path, and --print-job shows the job.
class Shortcut : public Command {
 public:
  CommandSpec describe() final;
  int run(const Session& session) final;

 protected:
  /// `options`: of stages, as "load_dem.tile_cells".
  explicit Shortcut(const std::vector<std::string_view>& options) : options_(options) {}
  Shortcut(const Shortcut&) = delete;
  Shortcut& operator=(const Shortcut&) = delete;

 private:
  /// Without the arguments every shortcut has.
  virtual CommandSpec describe_own() = 0;
  /// Throws Error{usage} where the files given make no job.
  virtual void add_stages(Pipeline& pipeline) const = 0;

  MapRequest request_;
  StageOptions options_;
  bool print_job_ = false;
};

}  // namespace waymark
