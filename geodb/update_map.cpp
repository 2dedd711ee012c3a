// SPDX-License-Identifier: Apache-2.0
#include "geodb/update_map.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "geodb/aside_file.hpp"
#include "geodb/open_map.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;

void copy_over(const fs::path& from, const fs::path& to) {
  std::error_code problem;
  fs::copy_file(from, to, fs::copy_options::overwrite_existing, problem);
  if (problem)
    throw Error(ErrorCode::output, "cannot copy the map: " + problem.message(), to.string(),
                "is there room, and may the folder be written?");
}

/// With what a killed writer left beside it, so that the copy is rolled back and not half written.
void copy_map(const fs::path& from, const fs::path& to) {
  copy_over(from, to);
  for (const char* suffix : {"-journal", "-wal"}) {
    const fs::path beside = from.string() + suffix;
    std::error_code none;
    if (fs::file_size(beside, none) > 0 && !none) copy_over(beside, to.string() + suffix);
  }
}

void remove_beside(const fs::path& map) {
  std::error_code ignored;
  for (const char* suffix : {"-journal", "-wal", "-shm"}) fs::remove(map.string() + suffix, ignored);
}

/// The file under a second name; it stays when the first name is given to another file.
void keep_as(const fs::path& map, const fs::path& backup) {
  std::error_code problem;
  fs::remove(backup, problem);
  fs::create_hard_link(map, backup, problem);
  if (!problem) return;
  AsideFile aside(backup);  // a disk that knows no links
  copy_over(map, aside.path());
  aside.keep();
}

}  // namespace

fs::path backup_name(const fs::path& map, std::size_t run) {
  return fmt::format("{}.before-run-{}", map.string(), run);
}

void update_map(const fs::path& original, const fs::path& result,
                const std::function<void(MapEditor&)>& changes) {
  open_for_reading(original);  // says what is wrong with it, by its own name
  std::error_code none;
  const bool in_place = fs::equivalent(original, result, none) && !none;
  AsideFile file(result);
  std::size_t run = 0;
  try {
    copy_map(original, file.path());
    MapEditor editor = MapEditor::open(file.path());
    run = editor.map().runs().size() + 1;
    editor.together([&] { changes(editor); });
  } catch (const Error& e) {
    remove_beside(file.path());
    throw Error(e.code(), e.problem(), e.where().ends_with(".part") ? result.string() : e.where(), e.hint());
  }
  remove_beside(file.path());
  if (in_place) keep_as(original, backup_name(result, run));
  file.keep();
  remove_beside(result);
}

fs::path restore_map(const fs::path& map) {
  const std::size_t run = MapStore::open(map).runs().size();
  const fs::path backup = backup_name(map, run);
  if (!fs::exists(backup))
    throw Error(ErrorCode::input, "the state before the last run of this map was not kept", map.string(),
                fmt::format("it would be {}", backup.string()));
  open_for_reading(backup);
  std::error_code problem;
  fs::rename(backup, map, problem);
  if (problem)
    throw Error(ErrorCode::output, "cannot restore the map: " + problem.message(), map.string(),
                "may the folder be written?");
  remove_beside(map);
  return backup;
}

}  // namespace waymark
