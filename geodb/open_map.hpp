// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include "geodb/sqlite.hpp"
namespace waymark {

struct OpenMap {
  sqlite::Database database;
  int version = 0;  ///< of the file, before any migration
};

/// For reading. Where reading would have to write first - a map of an older version, a transaction that was
/// killed, a write-ahead log in use - a private copy in the temporary folder is opened instead; it has no
/// name and vanishes with the connection. Throws Error with the path in it.
OpenMap open_for_reading(const std::filesystem::path& path);

/// For changing, migrated in place.
OpenMap open_for_changing(const std::filesystem::path& path);

}  // namespace waymark
