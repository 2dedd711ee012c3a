// SPDX-License-Identifier: Apache-2.0
#include "core/nameless_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "core/locked_folder.hpp"

namespace waymark::inline core {

int open_nameless_file(const std::filesystem::path& folder) {
  const int file = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0 || (errno != EOPNOTSUPP && errno != EISDIR)) return file;
  try {  // the folder, which is removed at once, is found by the next process if this one is killed
    const LockedFolder aside(folder);
    return ::open((aside.path() / "nameless").c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0600);
  } catch (const std::filesystem::filesystem_error& error) {
    errno = error.code().value();
    return -1;
  }
}

}  // namespace waymark::inline core
