// SPDX-License-Identifier: Apache-2.0
#include "workflows/output_path.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/error.hpp"
#include "geodb/map_store.hpp"

namespace waymark::workflows {
namespace {

namespace fs = std::filesystem;

void check_folder(const fs::path& folder, const fs::path& map) {
  if (!fs::exists(folder))
    throw Error(ErrorCode::output, "the folder of the output does not exist: " + folder.string(),
                map.string(), "make it with: mkdir -p " + folder.string());
  if (!fs::is_directory(folder))
    throw Error(ErrorCode::output, folder.string() + " is no folder", map.string(), "choose another -o");
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw Error(
        ErrorCode::output,
        "the folder of the output cannot be written: " + folder.string() + " (" + std::strerror(errno) + ")",
        map.string(), "choose another -o, or change its permissions");
}

/// An older map is replaced; anything else that has its name is somebody's work.
void check_old(const fs::path& map) {
  if (fs::is_directory(map))
    throw Error(ErrorCode::output, "the output is a folder", map.string(),
                "name a file in it: -o " + (map / "map.gpkg").string());
  if (!fs::exists(map)) return;
  if (fs::is_regular_file(map) && fs::file_size(map) == 0) return;  // as mktemp makes: nobody's work
  try {
    geodb::MapStore::open(map);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::environment) throw;  // a disk that fails says nothing about the file
    throw Error(ErrorCode::output,
                "the output exists and is no map of this version, so it is not replaced: " + error.problem(),
                map.string(), "remove it, or choose another -o");
  }
}

}  // namespace

void check_map_output(const fs::path& map) {
  if (map.extension() != ".gpkg")
    throw Error(ErrorCode::usage, "a map is a GeoPackage, so its name ends in .gpkg", map.string(),
                "e.g. -o " + fs::path(map).replace_extension(".gpkg").string());
  const fs::path folder = map.parent_path().empty() ? fs::path(".") : map.parent_path();
  check_folder(folder, map);
  check_old(map);
}

}  // namespace waymark::workflows
