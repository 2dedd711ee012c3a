// SPDX-License-Identifier: Apache-2.0
#include "importers/logs/zstd.hpp"

#include <cpl_compressor.h>

#include <stdexcept>

namespace waymark::importers {

bool is_zstd(std::string_view bytes) {
  return bytes.starts_with("\x28\xB5\x2F\xFD");
}

std::string unpacked_zstd(std::string_view bytes, std::optional<std::uint64_t> stated_size) {
  constexpr std::size_t kMaxRatio = 40000;  // zstd states 128 kB of one value in 4 bytes
  const CPLCompressor* codec = CPLGetDecompressor("zstd");
  if (codec == nullptr) throw std::runtime_error("it is compressed by zstd, which this GDAL lacks");
  std::size_t size = stated_size.value_or(0);
  if (!stated_size && !codec->pfnFunc(bytes.data(), bytes.size(), nullptr, &size, nullptr, codec->user_data))
    throw std::runtime_error("its zstd is damaged or empty");
  if (size / kMaxRatio > bytes.size()) throw std::runtime_error("it states more content than it can hold");
  std::string out(size, '\0');
  void* into = out.data();
  if (!codec->pfnFunc(bytes.data(), bytes.size(), &into, &size, nullptr, codec->user_data))
    throw std::runtime_error("its content cannot be decompressed");
  out.resize(size);
  return out;
}

}  // namespace waymark::importers
