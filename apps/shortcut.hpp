// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>
#include <vector>
#include "apps/command.hpp"
#include "apps/stage_options.hpp"
#include "pipeline/engine/pipeline.hpp"
#include "workflows/mapping/make_map.hpp"
namespace waymark::apps {

/// Command that builds a job from files and a few options of its stages, then runs it as `waymark run` does.
/// --print-job prints the job instead.
class Shortcut : public Command {
 public:
  CommandSpec describe() final;
  int run(const Session& session) final;

 protected:
  /// `options`: names of stage options, e.g. "load_dem.tile_cells".
  explicit Shortcut(const std::vector<std::string_view>& options) : options_(options) {}
  Shortcut(const Shortcut&) = delete;
  Shortcut& operator=(const Shortcut&) = delete;

 private:
  /// Returns the declaration without the arguments that all shortcuts share.
  virtual CommandSpec describe_own() = 0;
  /// Appends the stages of the job. Throws Error{usage} where the given files make no job.
  virtual void add_stages(pipeline::Pipeline& pipeline) const = 0;

  workflows::MapRequest request_;
  StageOptions options_;
  bool print_job_ = false;
};

}  // namespace waymark::apps
