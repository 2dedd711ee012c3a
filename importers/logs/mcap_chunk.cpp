// SPDX-License-Identifier: Apache-2.0
#include "importers/logs/mcap_chunk.hpp"

#include <cpl_compressor.h>
#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <stdexcept>

namespace waymark::importers {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers of LZ4 are little-endian");

/// Reader of the frames and blocks of LZ4. Matches may reach back into earlier blocks of their frame.
class Lz4Reader {
 public:
  Lz4Reader(std::string_view bytes, std::uint64_t size) : rest_(bytes), size_(size) {
    out_.reserve(static_cast<std::size_t>(size));
  }

  std::string frames() {
    while (!rest_.empty()) frame();
    return std::move(out_);
  }

 private:
  template <class T>
  static T take_number(std::string_view& from) {
    T value;
    std::memcpy(&value, take(from, sizeof value).data(), sizeof value);
    return value;
  }
  static std::string_view take(std::string_view& from, std::size_t count) {
    if (count > from.size()) throw std::runtime_error("its LZ4 ends too early");
    const std::string_view taken = from.substr(0, count);
    from.remove_prefix(count);
    return taken;
  }

  void frame() {
    constexpr std::uint32_t kFrame = 0x184D2204, kSkippable = 0x184D2A50, kStored = 0x80000000;
    enum Flag : unsigned { dictionary = 1, content_checksum = 4, content_size = 8, block_checksum = 16 };
    const auto magic = take_number<std::uint32_t>(rest_);
    if ((magic & 0xFFFFFFF0) == kSkippable) {
      take(rest_, take_number<std::uint32_t>(rest_));
      return;
    }
    const auto flags = magic == kFrame ? take_number<std::uint8_t>(rest_) : std::uint8_t{0};
    if (flags >> 6 != 1) throw std::runtime_error("its LZ4 has no frame of version 1");
    if (flags & dictionary) throw std::runtime_error("its LZ4 needs a dictionary");
    take(rest_, 1u + (flags & content_size ? 8 : 0) + 1u);  // block size, content size, checksum of these
    while (const auto head = take_number<std::uint32_t>(rest_)) {
      const std::string_view content = take(rest_, head & ~kStored);
      if (head & kStored)
        append(content);
      else
        block(content);
      if (flags & block_checksum) take(rest_, 4);
    }
    if (flags & content_checksum) take(rest_, 4);
  }

  /// Sequences of literals, and of a match with what has been written. The last has no match.
  void block(std::string_view in) {
    while (!in.empty()) {
      const auto token = take_number<std::uint8_t>(in);
      append(take(in, length(in, token >> 4)));
      if (in.empty()) return;
      const auto back = take_number<std::uint16_t>(in);
      const std::size_t count = length(in, token & 15) + 4;
      if (back == 0 || back > out_.size()) throw std::runtime_error("its LZ4 refers to what is not there");
      check_room(count);
      for (std::size_t from = out_.size() - back, i = 0; i < count; ++i) out_.push_back(out_[from + i]);
    }
  }

  static std::size_t length(std::string_view& in, std::size_t first) {
    std::size_t all = first;
    for (unsigned more = first == 15 ? 255 : 0; more == 255; all += more)
      more = take_number<std::uint8_t>(in);
    return all;
  }

  void append(std::string_view bytes) {
    check_room(bytes.size());
    out_.append(bytes);
  }
  void check_room(std::size_t more) const {
    if (more > size_ - out_.size()) throw std::runtime_error("it has more content than it states");
  }

  std::string_view rest_;
  std::uint64_t size_;
  std::string out_;
};

std::string unpacked_by_gdal(const std::string& compression, std::string_view bytes, std::uint64_t size) {
  const CPLCompressor* codec = CPLGetDecompressor(compression.c_str());
  if (codec == nullptr)
    throw std::runtime_error(fmt::format("its chunks are compressed by '{}'", compression));
  std::string out(static_cast<std::size_t>(size), '\0');
  void* into = out.data();
  std::size_t written = out.size();
  if (!codec->pfnFunc(bytes.data(), bytes.size(), &into, &written, nullptr, codec->user_data))
    throw std::runtime_error("its content cannot be decompressed");
  out.resize(written);
  return out;
}

}  // namespace

std::string unpacked_chunk(std::string_view compression, std::string_view bytes, std::uint64_t size) {
  constexpr std::uint64_t kMaxRatio = 40000;  // zstd states 128 kB of one value in 4 bytes
  if (size / kMaxRatio > bytes.size()) throw std::runtime_error("it states more content than it can hold");
  std::string out;
  if (compression == "lz4")
    out = Lz4Reader(bytes, size).frames();
  else if (compression == "zstd")
    out = unpacked_by_gdal("zstd", bytes, size);
  else
    throw std::runtime_error(fmt::format("its chunks are compressed by '{}'", compression));
  if (out.size() != size) throw std::runtime_error("it has less content than it states");
  return out;
}

}  // namespace waymark::importers
