// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include "core/atomic_file.hpp"
namespace waymark::geodb {

/// Rolls back the journal of a killed writer, and merges a write-ahead log into the map. Throws Error if
/// another process holds the map. Does nothing without such files.
void settle_journals(const std::filesystem::path& map);

/// Replaces an older map by a complete file. The older map's journals are settled first: SQLite finds them by
/// name, and would apply them to the new map.
void replace_map(AtomicFile& file);

}  // namespace waymark::geodb
