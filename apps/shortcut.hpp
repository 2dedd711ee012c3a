// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>
#include "apps/command.hpp"
#include "apps/map_arguments.hpp"
#include "core/options/option_table.hpp"
#include "pipeline/engine/pipeline.hpp"
namespace waymark::apps {

/// Options of stages on the command line of a shortcut: load_dem.tile_cells as --tile-cells. Unit, range,
/// choices, default and help are the stage's.
class StageOptions {
 public:
  /// Takes names such as "load_dem.tile_cells". Throws std::logic_error for an unknown option.
  explicit StageOptions(const std::vector<std::string_view>& names);

  /// Returns arguments that point into this object.
  std::vector<Argument> arguments();
  /// Sets the options that were given. Throws Error{usage} that names an option as it was typed.
  void apply(pipeline::Pipeline& pipeline) const;

 private:
  struct Offered {
    std::string stage;
    OptionRow row;
    std::string given;  ///< on the command line; empty: not
  };
  std::vector<Offered> offered_;
};

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

  MapCommand asked_;
  StageOptions options_;
  bool print_job_ = false;
};

}  // namespace waymark::apps
