// SPDX-License-Identifier: Apache-2.0
#include "importers/logs/mcap_chunk.hpp"

#include <fmt/format.h>
#include <lz4frame.h>

#include <memory>
#include <new>
#include <stdexcept>

#include "importers/logs/zstd.hpp"

namespace waymark::importers {
namespace {

struct FreeContext {
  void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
};

bool needs_dictionary(std::string_view frame) {
  constexpr std::size_t kFlags = 4;
  return frame.size() > kFlags && frame.starts_with("\x04\x22\x4D\x18") && (frame[kFlags] & 1) != 0;
}

// One frame or several, among them skippable ones.
std::string unpacked_lz4(std::string_view bytes, std::uint64_t size) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION))) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, FreeContext> context(made);
  std::string out(static_cast<std::size_t>(size), '\0');
  std::size_t written = 0, wanted = 0;  // bytes that the library still expects
  while (!bytes.empty()) {
    if (wanted == 0 && needs_dictionary(bytes)) throw std::runtime_error("its LZ4 needs a dictionary");
    std::size_t read = bytes.size(), room = out.size() - written;
    wanted = LZ4F_decompress(context.get(), out.data() + written, &room, bytes.data(), &read, nullptr);
    if (LZ4F_isError(wanted) && std::string_view(LZ4F_getErrorName(wanted)) == "ERROR_frameType_unknown")
      throw std::runtime_error("its LZ4 has no frame");
    if (LZ4F_isError(wanted))
      throw std::runtime_error(
          fmt::format("its LZ4 is damaged or refers to what is not there ({})", LZ4F_getErrorName(wanted)));
    if (read == 0 && room == 0) throw std::runtime_error("it has more content than it states");
    bytes.remove_prefix(read);
    written += room;
  }
  if (wanted != 0) throw std::runtime_error("its LZ4 ends too early");
  out.resize(written);
  return out;
}

}  // namespace

std::string unpacked_chunk(std::string_view compression, std::string_view bytes, std::uint64_t size) {
  constexpr std::uint64_t kMaxRatio = 40000;  // zstd states 128 kB of one value in 4 bytes
  if (size / kMaxRatio > bytes.size()) throw std::runtime_error("it states more content than it can hold");
  std::string out;
  if (compression == "lz4")
    out = unpacked_lz4(bytes, size);
  else if (compression == "zstd")
    out = unpacked_zstd(bytes, size);
  else
    throw std::runtime_error(fmt::format("its chunks are compressed by '{}'", compression));
  if (out.size() != size) throw std::runtime_error("it has less content than it states");
  return out;
}

}  // namespace waymark::importers
