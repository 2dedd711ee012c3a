// SPDX-License-Identifier: Apache-2.0
#include "geodb/atomic_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>

#include "core/error.hpp"

namespace waymark::geodb {
namespace {

constexpr std::string_view kSuffix = ".part";

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : ".";
}

[[noreturn]] void cannot_write(const std::filesystem::path& file, int cause) {
  const bool full = cause == ENOSPC || cause == EDQUOT;
  throw Error(ErrorCode::output,
              full ? "the disk is full" : std::string("cannot write: ") + std::strerror(cause), file.string(),
              full ? "free some space, or write to another disk" : "check the folder and its permissions");
}

// Removes the journal of a temporary file that is gone.
void remove_if_alone(const std::filesystem::path& journal, const std::filesystem::path& file) {
  std::error_code unknown;
  const bool gone = !std::filesystem::exists(file, unknown) && !unknown;
  if (gone) std::filesystem::remove(journal, unknown);
}

// Removes the files of dead writers: only these can be locked.
void remove_abandoned(const std::filesystem::path& folder, const std::string& prefix) {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename();
    if (!name.starts_with(prefix)) continue;
    if (const auto end = name.find(std::string(kSuffix) + "-"); end != std::string::npos)
      remove_if_alone(entry.path(), folder / name.substr(0, end + kSuffix.size()));
    if (!name.ends_with(kSuffix)) continue;
    const int file = ::open(entry.path().c_str(), O_RDWR | O_CLOEXEC);
    if (file < 0) continue;
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) {
      std::filesystem::remove(entry.path(), ignored);
      for (const char* companion : {"-journal", "-wal", "-shm"})
        std::filesystem::remove(entry.path().string() + companion, ignored);
    }
    ::close(file);
  }
}

void flush(const std::filesystem::path& path, int flags) {
  const int file = ::open(path.c_str(), flags | O_CLOEXEC);
  const bool flushed = file >= 0 && ::fsync(file) == 0;
  const int cause = errno;
  if (file >= 0) ::close(file);
  if (!flushed) cannot_write(path, cause);
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path final_path) : final_path_(std::move(final_path)) {
  static std::atomic<int> made = 0;
  const std::filesystem::path folder = folder_of(final_path_);
  const std::string prefix = "." + final_path_.filename().string() + ".";
  remove_abandoned(folder, prefix);
  path_ =
      folder / (prefix + std::to_string(::getpid()) + "-" + std::to_string(made++) + std::string(kSuffix));
  lock_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (lock_ < 0) cannot_write(final_path_, errno);
  ::flock(lock_, LOCK_EX | LOCK_NB);
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove(path_, ignored);
  ::close(lock_);
}

void AtomicFile::commit() {
  flush(path_, O_RDWR);
  if (::rename(path_.c_str(), final_path_.c_str()) != 0) cannot_write(final_path_, errno);
  path_.clear();
  flush(folder_of(final_path_), O_RDONLY | O_DIRECTORY);
}

}  // namespace waymark::geodb
