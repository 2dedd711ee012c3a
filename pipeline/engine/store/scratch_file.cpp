// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/store/scratch_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/error.hpp"
#include "core/nameless_file.hpp"

namespace waymark::pipeline {
namespace {

[[noreturn]] void cannot_write(const std::filesystem::path& folder, int cause) {
  const bool full = cause == ENOSPC || cause == EDQUOT;
  throw Error(ErrorCode::output,
              full ? std::string("the disk is full: tile results do not fit")
                   : std::string("cannot write temporary results: ") + std::strerror(cause),
              folder.string(), "free some space, or write to another disk");
}

}  // namespace

ScratchFile::ScratchFile(std::filesystem::path folder, std::size_t in_memory)
    : folder_(folder.empty() ? std::filesystem::temp_directory_path() : std::move(folder)),
      room_(in_memory) {}

ScratchFile::~ScratchFile() {
  if (file_ >= 0) ::close(file_);
}

void ScratchFile::open() {
  file_ = open_nameless_file(folder_);
  if (file_ < 0) cannot_write(folder_, errno);
}

std::function<std::string()> ScratchFile::put(std::string bytes) {
  const std::lock_guard lock(mutex_);
  if (bytes.size() <= room_) {
    room_ -= bytes.size();
    return [held = std::move(bytes)] { return held; };
  }
  if (file_ < 0) open();
  for (std::size_t done = 0; done < bytes.size();) {
    const ::ssize_t wrote =
        ::pwrite(file_, bytes.data() + done, bytes.size() - done, static_cast<::off_t>(end_ + done));
    if (wrote < 0 && errno != EINTR) cannot_write(folder_, errno);
    if (wrote > 0) done += static_cast<std::size_t>(wrote);
  }
  const std::uint64_t begin = std::exchange(end_, end_ + bytes.size());
  return [this, begin, size = bytes.size()] {
    std::string back(size, '\0');
    for (std::size_t done = 0; done < size;) {
      const ::ssize_t got =
          ::pread(file_, back.data() + done, size - done, static_cast<::off_t>(begin + done));
      if (got == 0 || (got < 0 && errno != EINTR))
        throw Error(ErrorCode::input,
                    std::string("cannot read temporary results: ") +
                        (got == 0 ? "the file is too short" : std::strerror(errno)),
                    folder_.string());
      if (got > 0) done += static_cast<std::size_t>(got);
    }
    return back;
  };
}

}  // namespace waymark::pipeline
