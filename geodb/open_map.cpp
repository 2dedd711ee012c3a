// SPDX-License-Identifier: Apache-2.0
#include "geodb/open_map.hpp"

#include <string>

#include "core/error.hpp"
#include "core/locked_folder.hpp"
#include "geodb/geopackage/migrations.hpp"

namespace waymark::geodb {
namespace {

namespace fs = std::filesystem;

void check_is_file(const fs::path& path) {
  if (!fs::exists(path))
    throw Error(ErrorCode::input, "there is no such map", path.string(), "check the name");
  if (!fs::is_regular_file(path))
    throw Error(ErrorCode::input, "this is not a file", path.string(),
                "a map is one file that ends in .gpkg");
  if (fs::file_size(path) == 0)
    throw Error(ErrorCode::input, "this file is empty", path.string(),
                "a map is made by `waymark run` or `waymark peaks`");
}

fs::path companion(const fs::path& path, const char* suffix) {
  return path.string() + suffix;
}

bool has_content(const fs::path& path) {
  std::error_code none;
  const auto size = fs::file_size(path, none);
  return !none && size > 0;
}

/// Returns true for a table that every map has.
bool is_table_of_maps(std::string_view name) {
  for (const std::string_view prefix : {"gpkg", "waymark_", "rtree_"})
    if (name.starts_with(prefix)) return true;
  for (const std::string_view table : {"observation", "image", "run", "layer_styles"})
    if (name == table) return true;
  return name.ends_with("_observation");
}

/// Throws Error{input} if a view stands where a map has a table: what it computes need not end. The view
/// `landmark` is for other programs and never read.
void check_no_view_is_read(const sqlite::Database& database) {
  const auto refuse = [](std::string_view name) {
    throw Error(ErrorCode::input, "the map's table '" + std::string(name) + "' is a view", "",
                "copy its rows into a table, or run the map's job again");
  };
  sqlite::Statement views = database.prepare("SELECT name FROM sqlite_master WHERE type = 'view'");
  while (views.step())
    if (is_table_of_maps(views.text(0))) refuse(views.text(0));
  for (const char* catalogue : {"waymark_type", "waymark_layer"}) {
    if (!database.has_table(catalogue)) continue;
    sqlite::Statement named = database.prepare(
        std::string("SELECT name FROM sqlite_master WHERE type = 'view' AND name IN (SELECT name FROM ") +
        catalogue + ")");
    if (named.step()) refuse(named.text(0));
  }
}

OpenMap open_private_copy(const fs::path& original) try {
  const LockedFolder folder(fs::temp_directory_path());  // files open in it outlive it
  const fs::path copy = folder.path() / "map.gpkg";
  try {
    fs::copy_file(original, copy);
    fs::permissions(copy, fs::perms::owner_read | fs::perms::owner_write);
    for (const char* suffix : {"-journal", "-wal"})
      if (has_content(companion(original, suffix)))
        fs::copy_file(companion(original, suffix), companion(copy, suffix));
  } catch (const fs::filesystem_error& e) {
    throw Error(ErrorCode::environment, "cannot make a private copy of the map: " + e.code().message(),
                original.string(), "set TMPDIR to a folder with room for it");
  }
  OpenMap map{sqlite::Database(copy, sqlite::OpenMode::update)};
  map.version = schema_version(map.database);  // the first read rolls back
  check_no_view_is_read(map.database);
  map.database.execute("PRAGMA locking_mode = EXCLUSIVE; PRAGMA journal_mode = MEMORY");
  migrate(map.database);
  map.database.execute("PRAGMA query_only = ON");
  return map;
} catch (const fs::filesystem_error& e) {
  throw Error(ErrorCode::environment,
              "cannot make a folder for a private copy of the map: " + e.code().message(), e.path1().string(),
              "set TMPDIR to a folder that can be written");
}

auto with_path(const fs::path& path, const auto& open) {
  return with_map_name(path, [&] {
    check_is_file(path);
    return open();
  });
}

}  // namespace

Error add_map_name(const Error& error, const fs::path& map) {
  const bool has_path = error.where().find(map.string()) != std::string::npos;
  return {error.code(), error.problem(),
          has_path ? error.where() : map.string() + (error.where().empty() ? "" : ", " + error.where()),
          error.hint()};
}

OpenMap open_for_reading(const fs::path& path) {
  return with_path(path, [&] {
    if (has_content(companion(path, "-wal"))) return open_private_copy(path);
    OpenMap map{sqlite::Database(path, sqlite::OpenMode::read)};
    try {
      map.version = schema_version(map.database);
    } catch (const Error& e) {
      if (e.code() != ErrorCode::output || !has_content(companion(path, "-journal"))) throw;
      return open_private_copy(path);  // an interrupted transaction, which only a writer may roll back
    }
    check_no_view_is_read(map.database);
    return map.version < kSchemaVersion ? open_private_copy(path) : std::move(map);
  });
}

OpenMap open_for_update(const fs::path& path) {
  return with_path(path, [&] {
    OpenMap map{sqlite::Database(path, sqlite::OpenMode::update)};
    map.version = schema_version(map.database);
    check_no_view_is_read(map.database);
    if (map.version < kSchemaVersion) migrate(map.database);
    return map;
  });
}

}  // namespace waymark::geodb
