// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include "geodb/map_editor.hpp"
namespace waymark {

/// Writes `original` with `changes` to `result`, which may be the same file, in one step: a copy beside
/// `result` is edited in one transaction, flushed and renamed, so that a process killed at any moment leaves
/// the old file or the new one, whole, and readers keep the one they have open. Where `result` is the
/// original, the old state is kept under backup_name() first. Throws Error as MapEditor does; nothing is
/// changed then.
void update_map(const std::filesystem::path& original, const std::filesystem::path& result,
                const std::function<void(MapEditor&)>& changes);

/// Where the state of a map before its run number `run` (from 1, as in the table run) is kept: beside it,
/// "<name>.before-run-<run>".
std::filesystem::path backup_name(const std::filesystem::path& map, std::size_t run);

/// Puts back the state before the last run and returns the name of the backup, which is used up. Throws
/// Error{input} where no backup of that state is there.
std::filesystem::path restore_map(const std::filesystem::path& map);

}  // namespace waymark
