// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/checked_writes.hpp"

#include <cpl_vsi.h>

#include <atomic>

namespace waymark::exporters {
namespace {

constexpr const char* kPrefix = "/vsiwaymark_checked/";

std::atomic<std::int64_t> failures = 0;

VSILFILE* file_of(void* handle) {
  return static_cast<VSILFILE*>(handle);
}

int counted(int result) {
  if (result != 0) ++failures;
  return result;
}

/// GDAL calls these with names without the prefix.
void describe(VSIFilesystemPluginCallbacksStruct& calls) {
  calls.stat = [](void*, const char* name, VSIStatBufL* status, int flags) {
    return VSIStatExL(name, status, flags);
  };
  calls.unlink = [](void*, const char* name) { return VSIUnlink(name); };
  calls.rename = [](void*, const char* from, const char* to) { return counted(VSIRename(from, to)); };
  calls.mkdir = [](void*, const char* name, long mode) { return VSIMkdir(name, mode); };
  calls.rmdir = [](void*, const char* name) { return VSIRmdir(name); };
  calls.read_dir = [](void*, const char* name, int count) { return VSIReadDirEx(name, count); };
  calls.open = [](void*, const char* name, const char* access) -> void* { return VSIFOpenL(name, access); };
  calls.tell = [](void* file) { return VSIFTellL(file_of(file)); };
  calls.seek = [](void* file, vsi_l_offset to, int from) { return VSIFSeekL(file_of(file), to, from); };
  calls.read = [](void* file, void* bytes, std::size_t size, std::size_t count) {
    return VSIFReadL(bytes, size, count, file_of(file));
  };
  calls.eof = [](void* file) { return VSIFEofL(file_of(file)); };
  calls.write = [](void* file, const void* bytes, std::size_t size, std::size_t count) {
    const std::size_t written = VSIFWriteL(bytes, size, count, file_of(file));
    if (written < count) ++failures;
    return written;
  };
  calls.flush = [](void* file) { return counted(VSIFFlushL(file_of(file))); };
  calls.truncate = [](void* file, vsi_l_offset size) { return counted(VSIFTruncateL(file_of(file), size)); };
  calls.close = [](void* file) { return counted(VSIFCloseL(file_of(file))); };
}

bool install() {
  VSIFilesystemPluginCallbacksStruct* calls = VSIAllocFilesystemPluginCallbacksStruct();
  describe(*calls);
  const bool installed = VSIInstallPluginHandler(kPrefix, calls) == 0;
  VSIFreeFilesystemPluginCallbacksStruct(calls);
  return installed;
}

}  // namespace

std::string with_checked_writes(const std::string& path) {
  static const bool installed = install();
  return installed ? kPrefix + path : path;
}

std::int64_t failed_writes() {
  return failures;
}

}  // namespace waymark::exporters
