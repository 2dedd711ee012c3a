// SPDX-License-Identifier: Apache-2.0
#include "geodb/replace_map.hpp"

#include <string>

#include "core/error.hpp"
#include "geodb/sqlite/sqlite.hpp"

namespace waymark::geodb {
namespace {

namespace fs = std::filesystem;

bool is_filled(const fs::path& path) {
  std::error_code none;
  const auto size = fs::file_size(path, none);
  return !none && size > 0;
}

void remove_journals(const fs::path& map) {
  std::error_code ignored;
  for (const char* suffix : {"-journal", "-wal", "-shm"}) fs::remove(map.string() + suffix, ignored);
}

}  // namespace

void settle_journals(const fs::path& map) try {
  if (!is_filled(map.string() + "-journal") && !is_filled(map.string() + "-wal")) return;
  if (!is_filled(map)) return remove_journals(map);  // of a map that is gone
  const sqlite::Database database(map, sqlite::OpenMode::update);
  database.execute("BEGIN IMMEDIATE; COMMIT; PRAGMA wal_checkpoint(TRUNCATE)");
} catch (const Error& error) {
  if (error.code() == ErrorCode::output)
    throw Error(ErrorCode::output, "cannot finish what another program left in the map: " + error.problem(),
                map.string(), "close the other program, or write to another file");
  remove_journals(map);  // of a file that is no database
}

void replace_map(AtomicFile& file) {
  settle_journals(file.target());
  file.commit();
  remove_journals(file.target());
}

}  // namespace waymark::geodb
