// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "tests/apps/program.hpp"
namespace waymark::test {

/// A command with two versions, whose outputs go to the folder `out`. $OUT is that folder, $IN that of the
/// inputs.
struct Command {
  std::string name;
  std::string older, newer;
  bool edits_map = false;  ///< SQLite changes a map in place: the older state is kept in a journal
  std::vector<std::string> inputs = {};  ///< commands that make what `older` and `newer` read
  bool can_repeat = true;                ///< whether the newer command can run on its own outputs
};

void PrintTo(const Command& command, std::ostream* out);

/// Returns whether WAYMARK_SLOW_TESTS is set.
bool is_slow();

/// Returns every command that writes; that of training is among them in slow tests only.
const std::vector<Command>& commands();

/// Writes the inputs of all commands.
void write_inputs(const TempFolder& in);

}  // namespace waymark::test
