// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>
#include "apps/command.hpp"
#include "pipeline/engine/option_table.hpp"
#include "pipeline/engine/pipeline.hpp"
namespace waymark {

/// Options of stages that a shortcut offers on its command line: load_dem.tile_cells as --tile-cells. Unit,
/// range, choices, default and help are the stage's own.
class StageOptions {
 public:
  /// "load_dem.tile_cells"; throws std::logic_error where the stage has no such option.
  explicit StageOptions(const std::vector<std::string_view>& names);

  /// They point into this object.
  std::vector<Argument> arguments();
  /// Sets those that were given. Throws Error{usage} naming the option as it was typed.
  void apply(Pipeline& pipeline) const;

 private:
  struct Offered {
    std::string stage;
    OptionRow row;
    std::string given;  ///< on the command line; empty: not
  };
  std::vector<Offered> offered_;
};

}  // namespace waymark
