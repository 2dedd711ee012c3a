// SPDX-License-Identifier: Apache-2.0
#include "exporters/web/gzip.hpp"

#include <cpl_conv.h>

#include <array>
#include <cstdint>
#include <memory>

#include "core/error.hpp"

namespace waymark::exporters {
namespace {

constexpr std::array<std::uint32_t, 256> kCrcTable = [] {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t c = i;
    for (int bit = 0; bit < 8; ++bit) c = c & 1 ? 0xedb88320u ^ (c >> 1) : c >> 1;
    table[i] = c;
  }
  return table;
}();

std::uint32_t crc32(std::string_view bytes) {
  std::uint32_t c = ~0u;
  for (const char byte : bytes) c = kCrcTable[(c ^ static_cast<unsigned char>(byte)) & 0xff] ^ (c >> 8);
  return ~c;
}

void append_little_endian(std::string& bytes, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 0xff);
}

}  // namespace

std::string gzip(std::string_view bytes) {
  constexpr int level = 6;
  std::size_t size = 0;
  const std::unique_ptr<void, decltype(&VSIFree)> zlib(
      CPLZLibDeflate(bytes.data(), bytes.size(), level, nullptr, 0, &size), VSIFree);
  constexpr std::size_t header = 2, checksum = 4;  // of zlib (RFC 1950), around the same deflated bytes
  if (!zlib || size < header + checksum)
    throw Error(ErrorCode::environment, "a tile could not be compressed: out of memory");
  std::string file("\x1f\x8b\x08\0\0\0\0\0\0\xff", 10);
  file.append(static_cast<const char*>(zlib.get()) + header, size - header - checksum);
  append_little_endian(file, crc32(bytes));
  append_little_endian(file, static_cast<std::uint32_t>(bytes.size()));
  return file;
}

}  // namespace waymark::exporters
