// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include "geodb/map_editor.hpp"
namespace waymark::geodb {

/// Writes `original` with `changes` to `result`, which may be the same file, atomically.
/// - A copy beside `result` is edited in one transaction, flushed and renamed. A killed process leaves the
///   old file or the new one; readers continue with the file they have open.
/// - If `result` is `original`, its old state is first saved as backup_name().
/// - Throws Error as MapEditor; the files are then unchanged.
void update_map(const std::filesystem::path& original, const std::filesystem::path& result,
                const std::function<void(MapEditor&)>& changes);

/// Returns the name of the backup of a map before its run number `run` (from 1, as in the table run):
/// "<map>.before-run-<run>".
std::filesystem::path backup_name(const std::filesystem::path& map, std::size_t run);

/// Restores the state before the last run from its backup, which is renamed. Returns the name of the backup.
/// Throws Error{input} if there is no backup of that state.
std::filesystem::path restore_map(const std::filesystem::path& map);

}  // namespace waymark::geodb
