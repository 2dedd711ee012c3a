// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>
#include "apps/command.hpp"
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

}  // namespace waymark::apps
