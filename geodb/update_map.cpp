// SPDX-License-Identifier: Apache-2.0
#include "geodb/update_map.hpp"

#include <fmt/format.h>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "geodb/open_map.hpp"
#include "geodb/replace_map.hpp"
#include "geodb/validate_map.hpp"

namespace waymark::geodb {
namespace {

namespace fs = std::filesystem;

void overwrite_copy(const fs::path& from, const fs::path& to) {
  std::error_code problem;
  fs::copy_file(from, to, fs::copy_options::overwrite_existing, problem);
  if (problem)
    throw Error(ErrorCode::output, "cannot copy the map: " + problem.message(), to.string(),
                "check the free space and the permissions of the folder");
}

/// Copies a map with the journal of a killed writer, so that the copy is rolled back.
void copy_map(const fs::path& from, const fs::path& to) {
  overwrite_copy(from, to);
  for (const char* suffix : {"-journal", "-wal"}) {
    const fs::path companion = from.string() + suffix;
    std::error_code none;
    if (fs::file_size(companion, none) > 0 && !none) overwrite_copy(companion, to.string() + suffix);
  }
}

/// Saves the file under a second name, by a hard link if possible.
void save_backup(const fs::path& map, const fs::path& backup) {
  std::error_code problem;
  fs::remove(backup, problem);
  fs::create_hard_link(map, backup, problem);
  if (!problem) return;
  AtomicFile copy(backup);  // a file system without hard links
  overwrite_copy(map, copy.path());
  copy.commit();
}

}  // namespace

fs::path backup_name(const fs::path& map, std::size_t run) {
  return fmt::format("{}.before-run-{}", map.string(), run);
}

void update_map(const fs::path& original, const fs::path& result,
                const std::function<void(MapEditor&)>& changes) {
  check_before_copy(original);
  std::error_code none;
  const bool in_place = fs::equivalent(original, result, none) && !none;
  if (in_place) settle_journals(original);  // else the backup lacks the journal that makes it whole
  AtomicFile file(result);
  std::size_t run = 0;
  try {
    copy_map(original, file.path());
    MapEditor editor = MapEditor::open(file.path());
    run = editor.map().runs().size() + 1;
    editor.transact([&] { changes(editor); });
  } catch (const Error& e) {
    throw with_final_path(e, file.path(), result);
  }
  if (in_place) save_backup(original, backup_name(result, run));
  replace_map(file);
}

fs::path restore_map(const fs::path& map) {
  const std::size_t run = MapStore::open(map).runs().size();
  const fs::path backup = backup_name(map, run);
  if (!fs::exists(backup))
    throw Error(ErrorCode::input, "there is no backup of this map before its last run", map.string(),
                fmt::format("its name would be {}", backup.string()));
  open_for_reading(backup);
  settle_journals(map);
  std::error_code problem;
  fs::rename(backup, map, problem);
  if (problem)
    throw Error(ErrorCode::output, "cannot restore the map: " + problem.message(), map.string(),
                "check the permissions of the folder");
  return backup;
}

}  // namespace waymark::geodb
