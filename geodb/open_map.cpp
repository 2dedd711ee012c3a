// SPDX-License-Identifier: Apache-2.0
#include "geodb/open_map.hpp"

#include <cstdlib>
#include <string>

#include "core/error.hpp"
#include "geodb/migrations.hpp"

namespace waymark {
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

fs::path beside(const fs::path& path, const char* suffix) {
  return path.string() + suffix;
}

bool has_content(const fs::path& path) {
  std::error_code none;
  const auto size = fs::file_size(path, none);
  return !none && size > 0;
}

/// A folder of our own that vanishes at the end of the scope; files open in it live on.
class PrivateFolder {
 public:
  PrivateFolder() {
    std::string name = (fs::temp_directory_path() / "waymark-XXXXXX").string();
    if (!::mkdtemp(name.data()))
      throw Error(ErrorCode::environment, "cannot make a folder for a private copy of the map", name,
                  "set TMPDIR to a folder that can be written");
    path_ = name;
  }
  ~PrivateFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

OpenMap open_private_copy(const fs::path& original) {
  const PrivateFolder folder;
  const fs::path copy = folder.path() / "map.gpkg";
  try {
    fs::copy_file(original, copy);
    fs::permissions(copy, fs::perms::owner_read | fs::perms::owner_write);
    for (const char* suffix : {"-journal", "-wal"})
      if (has_content(beside(original, suffix)))
        fs::copy_file(beside(original, suffix), beside(copy, suffix));
  } catch (const fs::filesystem_error& e) {
    throw Error(ErrorCode::environment, "cannot make a private copy of the map: " + e.code().message(),
                original.string(), "set TMPDIR to a folder with room for it");
  }
  OpenMap map{sqlite::Database(copy, sqlite::OpenMode::update)};
  map.version = schema_version(map.database);  // the first read rolls back
  map.database.execute("PRAGMA locking_mode = EXCLUSIVE; PRAGMA journal_mode = MEMORY");
  migrate(map.database);
  map.database.execute("PRAGMA query_only = ON");
  return map;
}

auto with_path(const fs::path& path, const auto& open) {
  try {
    check_is_file(path);
    return open();
  } catch (const Error& e) {
    const bool placed = e.where().find(path.string()) != std::string::npos;
    throw Error(e.code(), e.problem(),
                placed ? e.where() : path.string() + (e.where().empty() ? "" : ", " + e.where()), e.hint());
  }
}

}  // namespace

OpenMap open_for_reading(const fs::path& path) {
  return with_path(path, [&] {
    if (has_content(beside(path, "-wal"))) return open_private_copy(path);
    OpenMap map{sqlite::Database(path, sqlite::OpenMode::read)};
    try {
      map.version = schema_version(map.database);
    } catch (const Error& e) {
      if (e.code() != ErrorCode::output || !has_content(beside(path, "-journal"))) throw;
      return open_private_copy(path);  // a killed transaction, which only a writer may roll back
    }
    return map.version < kSchemaVersion ? open_private_copy(path) : std::move(map);
  });
}

OpenMap open_for_changing(const fs::path& path) {
  return with_path(path, [&] {
    OpenMap map{sqlite::Database(path, sqlite::OpenMode::update)};
    map.version = schema_version(map.database);
    if (map.version < kSchemaVersion) migrate(map.database);
    return map;
  });
}

}  // namespace waymark
