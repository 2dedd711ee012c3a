// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include "core/error.hpp"
#include "geodb/sqlite/sqlite.hpp"
namespace waymark::geodb {

/// Connection to a map file.
struct OpenMap {
  sqlite::Database database;
  int version = 0;  ///< of the file, before any migration
};

/// Opens a map for reading. Opens a private copy in the temporary folder if reading requires writing: an
/// older schema version, an interrupted transaction, a write-ahead log. The copy is unlinked and vanishes
/// with the connection. Throws Error that names the path.
OpenMap open_for_reading(const std::filesystem::path& path);

/// Opens a map for writing, and migrates it in place.
OpenMap open_for_update(const std::filesystem::path& path);

/// Returns the error with the path of the map in its location.
Error add_map_name(const Error& error, const std::filesystem::path& map);

/// Returns action(); an Error that it throws names the map.
template <class Action>
auto with_map_name(const std::filesystem::path& map, const Action& action) {
  try {
    return action();
  } catch (const Error& error) {
    throw add_map_name(error, map);
  }
}

}  // namespace waymark::geodb
