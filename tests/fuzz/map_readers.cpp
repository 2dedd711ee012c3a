// SPDX-License-Identifier: Apache-2.0
#include "map_readers.hpp"

#include <sqlite3.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/text_file.hpp"
#include "geodb/validate_map.hpp"
#include "geodb/write_map.hpp"
#include "tests/support/whole_map.hpp"

namespace waymark::test {
namespace {

namespace fs = std::filesystem;

/// Throws Error{input} if the map has errors.
void read_map(const std::string& path) {
  const bool sound = geodb::validate_map(path).empty();
  read_whole_map(path);
  if (!sound) throw Error(ErrorCode::input, "the map has errors", path);
}

std::string map_beside(const std::string& file, const std::string& bytes) {
  const std::string map = (fs::path(file).parent_path() / "map.gpkg").string();
  for (const char* part : {"", "-journal", "-wal", "-shm"}) fs::remove(map + part);
  if (write_aside(map, bytes) != 0) throw std::runtime_error("cannot write " + map);
  return map;
}

}  // namespace

const std::string& sound_map() {
  static const std::string bytes = [] {
    std::string folder = (fs::temp_directory_path() / "waymark-map-XXXXXX").string();
    if (!::mkdtemp(folder.data())) throw std::runtime_error("cannot make " + folder);
    geodb::write_map(folder + "/map.gpkg", map_with_everything(6, 3), {.empty_tables = {"rock"}});
    std::string made = read_text(folder + "/map.gpkg", "the map");
    fs::remove_all(folder);
    return made;
  }();
  return bytes;
}

void read_edited_map(const std::string& edits) {
  constexpr std::size_t kPosition = 3, kContent = 4;
  const std::string text = read_text(edits, "the edits");
  std::string bytes = sound_map();
  for (std::size_t i = 0; i + kPosition + kContent <= text.size(); i += kPosition + kContent) {
    std::size_t at = 0;
    for (std::size_t k = 0; k < kPosition; ++k) at = at * 256 + static_cast<std::uint8_t>(text[i + k]);
    bytes.replace(at % (bytes.size() - kContent), kContent, text, i + kPosition, kContent);
  }
  read_map(map_beside(edits, bytes));
}

void read_altered_map(const std::string& sql) {
  const std::string text = read_text(sql, "the statements");
  const std::string map = map_beside(sql, sound_map());
  {
    sqlite3* opened = nullptr;
    if (sqlite3_open(map.c_str(), &opened) != SQLITE_OK) throw std::runtime_error("cannot open " + map);
    const std::unique_ptr<sqlite3, decltype(&sqlite3_close)> db(opened, sqlite3_close);
    sqlite3_db_config(db.get(), SQLITE_DBCONFIG_WRITABLE_SCHEMA, 1, nullptr);
    sqlite3_limit(db.get(), SQLITE_LIMIT_ATTACHED, 0);
    sqlite3_limit(db.get(), SQLITE_LIMIT_LENGTH, 1 << 20);
    sqlite3_progress_handler(
        db.get(), 100'000, [](void*) { return 1; }, nullptr);
    sqlite3_exec(db.get(), "PRAGMA synchronous = OFF", nullptr, nullptr, nullptr);
    const char* rest = text.c_str();
    while (*rest) {  // one at a time: those that fail do not end the others
      sqlite3_stmt* statement = nullptr;
      const char* end = rest;
      if (sqlite3_prepare_v2(db.get(), rest, -1, &statement, &end) != SQLITE_OK || end == rest) break;
      for (int step = 0; step < 1000 && sqlite3_step(statement) == SQLITE_ROW; ++step) continue;
      sqlite3_finalize(statement);
      rest = end;
    }
  }
  read_map(map);
}

}  // namespace waymark::test
