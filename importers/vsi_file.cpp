// SPDX-License-Identifier: Apache-2.0
#include "importers/vsi_file.hpp"

#include <cpl_vsi.h>

#include "core/error.hpp"

namespace waymark::importers {
namespace {

VSILFILE* handle(void* file) {
  return static_cast<VSILFILE*>(file);
}

}  // namespace

VsiFile::VsiFile(const std::string& path) : file_(nullptr) {
  VSIStatBufL status;
  if (VSIStatL(path.c_str(), &status) == 0 && VSI_ISDIR(status.st_mode))
    throw Error(ErrorCode::input, "it is a folder, not a file", path, "name the files in it");
  file_ = VSIFOpenL(path.c_str(), "rb");
  if (file_ == nullptr)
    throw Error(ErrorCode::input, "the file does not exist or cannot be read", path, "check its name");
}

VsiFile::~VsiFile() {
  VSIFCloseL(handle(file_));
}

std::size_t VsiFile::read(std::uint64_t offset, void* into, std::size_t count) {
  if (VSIFSeekL(handle(file_), offset, SEEK_SET) != 0) return 0;
  return VSIFReadL(into, 1, count, handle(file_));
}

std::uint64_t VsiFile::size() {
  VSIFSeekL(handle(file_), 0, SEEK_END);
  return VSIFTellL(handle(file_));
}

}  // namespace waymark::importers
