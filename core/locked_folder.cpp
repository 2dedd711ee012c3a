// SPDX-License-Identifier: Apache-2.0
#include "core/locked_folder.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <system_error>

namespace waymark::inline core {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kRandom = 6;  // characters of mkdtemp

enum class LockState { ours, of_another, impossible };
struct FolderLock {
  LockState state;
  int handle;  ///< -1 unless ours
};

FolderLock lock_folder(const fs::path& folder) {
  const int handle = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (handle < 0) return {LockState::impossible, -1};
  if (::flock(handle, LOCK_EX | LOCK_NB) == 0) return {LockState::ours, handle};
  const bool held = errno == EWOULDBLOCK;
  ::close(handle);
  return {held ? LockState::of_another : LockState::impossible, -1};
}

/// Returns false if another process has removed the folder.
bool is_there(const fs::path& folder, const FolderLock& lock) {
  struct stat named {
  }, locked{};
  if (::stat(folder.c_str(), &named) != 0) return false;
  return lock.handle < 0 || (::fstat(lock.handle, &locked) == 0 && named.st_ino == locked.st_ino);
}

std::string host_name() {
  std::array<char, 256> name{};
  ::gethostname(name.data(), name.size() - 1);
  std::string host = name.data();
  std::ranges::replace(host, '/', '_');
  return host.substr(0, 64);
}

/// Process and host in the name of a locked folder.
struct Owner {
  ::pid_t process;
  std::string_view host;
};

/// Returns `std::nullopt` for a name that is not .waymark-<process>-<host>-XXXXXX.
std::optional<Owner> owner_of(std::string_view name) {
  if (!name.starts_with(kAsidePrefix)) return {};
  name.remove_prefix(kAsidePrefix.size());
  Owner owner{};
  const auto [end, problem] = std::from_chars(name.data(), name.data() + name.size(), owner.process);
  if (problem != std::errc() || owner.process <= 0) return {};
  name.remove_prefix(static_cast<std::size_t>(end - name.data()));
  if (name.size() < kRandom + 3 || name.front() != '-' || name[name.size() - kRandom - 1] != '-') return {};
  owner.host = name.substr(1, name.size() - kRandom - 2);
  return owner;
}

bool is_dead(const Owner& owner) {
  return owner.host == host_name() && ::kill(owner.process, 0) != 0 && errno == ESRCH;
}

/// Folders that this process removes. Never destroyed: a signal may come while the process ends.
struct OwnFolders {
  std::mutex mutex;
  std::set<fs::path> paths;
};

OwnFolders& own_folders() {
  static auto* const all = new OwnFolders;
  return *all;
}

}  // namespace

void remove_own_folders() noexcept try {
  OwnFolders& own = own_folders();
  const std::lock_guard lock(own.mutex);
  std::error_code ignored;
  for (const fs::path& folder : own.paths)
    for (int tries = 0; tries < 8 && fs::exists(folder, ignored); ++tries)  // other threads may write to it
      fs::remove_all(folder, ignored);
} catch (const std::exception&) {  // left to the next process
}

void remove_dead_folders(const fs::path& parent, const std::function<void(const fs::path&)>& before_removal) {
  std::error_code ignored;  // another process may be clearing the same folder
  for (fs::directory_iterator entry(parent, ignored), end; entry != end; entry.increment(ignored)) {
    const std::string name = entry->path().filename().string();
    const std::optional<Owner> owner = owner_of(name);
    if (!owner) continue;
    const FolderLock lock = lock_folder(entry->path());
    // On file systems without locks, the name decides.
    const bool dead =
        lock.state == LockState::ours || (lock.state == LockState::impossible && is_dead(*owner));
    if (dead && is_there(entry->path(), lock)) try {
        if (before_removal) before_removal(entry->path());
        fs::remove_all(entry->path(), ignored);
      } catch (const std::exception&) {  // left to a process that can finish it
      }
    if (lock.handle >= 0) ::close(lock.handle);
  }
}

LockedFolder::LockedFolder(const fs::path& parent,
                           const std::function<void(const fs::path&)>& before_removal) {
  remove_dead_folders(parent, before_removal);
  const std::string pattern =
      (parent / (std::string(kAsidePrefix) + std::to_string(::getpid()) + "-" + host_name() + "-XXXXXX"))
          .string();
  // Another process may lock or remove the folder between its making and its locking.
  for (int tries = 0; tries < 8; ++tries) {
    std::string name = pattern;
    if (::mkdtemp(name.data()) == nullptr) break;
    const FolderLock lock = lock_folder(name);
    if (lock.state != LockState::of_another && is_there(name, lock)) {
      lock_ = lock.handle;
      path_ = name;
      reclaim();
      return;
    }
    if (lock.handle >= 0) ::close(lock.handle);
    errno = EBUSY;
  }
  throw fs::filesystem_error("cannot make a folder", pattern,
                             std::error_code(errno, std::generic_category()));
}

void LockedFolder::abandon() {
  const std::lock_guard lock(own_folders().mutex);
  own_folders().paths.erase(path_);
}

void LockedFolder::reclaim() {
  const std::lock_guard lock(own_folders().mutex);
  own_folders().paths.insert(path_);
}

bool LockedFolder::is_abandoned() const {
  const std::lock_guard lock(own_folders().mutex);
  return !own_folders().paths.contains(path_);
}

LockedFolder::~LockedFolder() {
  std::error_code ignored;
  if (!is_abandoned()) fs::remove_all(path_, ignored);
  abandon();
  if (lock_ >= 0) ::close(lock_);
}

}  // namespace waymark::inline core
