// SPDX-License-Identifier: Apache-2.0
#include "core/locked_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

namespace waymark::inline core {
namespace {

namespace fs = std::filesystem;

/// Returns the locked folder, or -1: another process holds it, or the file system has no locks.
int lock_folder(const fs::path& folder) {
  const int handle = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (handle < 0 || ::flock(handle, LOCK_EX | LOCK_NB) == 0) return handle;
  ::close(handle);
  return -1;
}

/// Returns true for PREFIX<process>-XXXXXX.
bool is_ours(std::string_view name, std::string_view prefix) {
  if (!name.starts_with(prefix)) return false;
  name.remove_prefix(prefix.size());
  const std::size_t dash = name.find('-');
  return dash != std::string_view::npos && dash > 0 && name.size() == dash + 7 &&
         std::all_of(name.begin(), name.begin() + static_cast<std::ptrdiff_t>(dash),
                     [](char c) { return c >= '0' && c <= '9'; });
}

void remove_dead(const fs::path& parent, std::string_view prefix) {
  std::error_code ignored;  // another process may be clearing the same folder
  for (fs::directory_iterator entry(parent, ignored), end; entry != end; entry.increment(ignored)) {
    if (!is_ours(entry->path().filename().string(), prefix)) continue;
    const int lock = lock_folder(entry->path());
    if (lock < 0) continue;
    fs::remove_all(entry->path(), ignored);
    ::close(lock);
  }
}

}  // namespace

LockedFolder::LockedFolder(const fs::path& parent, std::string_view prefix) {
  remove_dead(parent, prefix);
  const std::string pattern =
      (parent / (std::string(prefix) + std::to_string(::getpid()) + "-XXXXXX")).string();
  // Another process may remove the folder between its making and its locking.
  for (int tries = 0; tries < 8; ++tries) {
    std::string name = pattern;
    if (::mkdtemp(name.data()) == nullptr) break;
    lock_ = lock_folder(name);
    std::error_code unknown;
    path_ = name;
    if (fs::is_directory(path_, unknown)) return;
    if (lock_ >= 0) ::close(lock_);
    lock_ = -1;
  }
  throw fs::filesystem_error("cannot make a folder", pattern,
                             std::error_code(errno, std::generic_category()));
}

LockedFolder::~LockedFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  if (lock_ >= 0) ::close(lock_);
}

}  // namespace waymark::inline core
