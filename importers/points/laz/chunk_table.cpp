// SPDX-License-Identifier: Apache-2.0
#include "importers/points/laz/chunk_table.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "importers/points/laz/integer_decoder.hpp"
#include "importers/vsi_file.hpp"

namespace waymark::importers {
namespace {

constexpr std::uint64_t kBefore = 8;  // bytes between the header and the first chunk: where the table is

[[noreturn]] void refuse_table(const LasHeader& header, const std::string& problem) {
  throw Error(ErrorCode::input, problem, header.path, "copy or download it again");
}

template <class T>
T number_in(VsiFile& file, std::uint64_t offset, const LasHeader& header) {
  T value{};
  if (file.read(offset, &value, sizeof value) != sizeof value)
    refuse_table(header, "the file ends before the table of its chunks");
  return value;
}

// A writer that cannot seek leaves -1 and puts the position into the last 8 bytes.
std::uint64_t table_offset(VsiFile& file, const LasHeader& header) {
  auto offset = number_in<std::int64_t>(file, header.first_point, header);
  if (offset == -1) offset = number_in<std::int64_t>(file, file.size() - 8, header);
  const auto first = static_cast<std::int64_t>(header.first_point + kBefore);
  if (offset <= first && header.points > 0)
    refuse_table(header, "the file has no table of its chunks: it was not finished");
  if (offset > static_cast<std::int64_t>(file.size()) - 8)
    refuse_table(header,
                 fmt::format("the file is truncated: the table of its chunks would be at byte {}, it has {}",
                             offset, file.size()));
  return static_cast<std::uint64_t>(offset);
}

// Sizes are coded as differences to the one before; numbers of points likewise, if chunks differ.
std::vector<LazChunk> decoded_table(const std::vector<unsigned char>& bytes, std::uint32_t count,
                                    bool any_count) {
  std::vector<LazChunk> chunks;
  ArithmeticDecoder from(bytes);
  IntegerDecoder numbers(32, 2);
  std::int32_t points = 0, size = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (any_count) points = numbers.next(from, points, 0);
    size = numbers.next(from, size, 1);
    chunks.push_back({0, static_cast<std::uint32_t>(size), static_cast<std::uint32_t>(points)});
  }
  return chunks;
}

void place_chunks(std::vector<LazChunk>& chunks, const LasHeader& header, std::uint64_t end) {
  const std::uint64_t usual = header.laz->chunk_points;
  std::uint64_t offset = header.first_point + kBefore, points = 0;
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    LazChunk& chunk = chunks[i];
    chunk.offset = offset;
    if (usual != LazRecord::kAnyCount) chunk.points = std::min(usual, header.points - points);
    const bool room = chunk.bytes <= end - offset;
    const bool holds = chunk.points == 0 || chunk.bytes >= static_cast<std::uint64_t>(header.point_length);
    if (!room || !holds || chunk.points > header.points - points)
      refuse_table(header,
                   fmt::format("the table of its chunks is damaged: chunk {} of {} would have {} points in "
                               "{} bytes",
                               i + 1, chunks.size(), chunk.points, chunk.bytes));
    offset += chunk.bytes;
    points += chunk.points;
  }
  if (points != header.points)
    refuse_table(header,
                 fmt::format("the header states {} points, its chunks hold {}", header.points, points));
}

}  // namespace

std::vector<LazChunk> read_chunk_table(const LasHeader& header) {
  VsiFile file(header.path);
  const std::uint64_t size = file.size();
  if (header.points == 0) return {};
  if (header.laz->compressor == 1) return {{header.first_point, size - header.first_point, header.points}};
  const std::uint64_t at = table_offset(file, header);
  const auto version = number_in<std::uint32_t>(file, at, header);
  const auto count = number_in<std::uint32_t>(file, at + 4, header);
  if (version != 0)
    refuse_table(header, fmt::format("the table of its chunks has version {}; 0 is known", version));
  // The first point of a chunk is not compressed.
  if (count > size / static_cast<std::uint64_t>(header.point_length))
    refuse_table(header,
                 fmt::format("the table of its chunks is damaged: {} chunks in {} bytes", count, size));
  // An entry takes two integers of 6 bytes at most.
  std::vector<unsigned char> bytes(
      static_cast<std::size_t>(std::min<std::uint64_t>(size - at - 8, 16 + std::uint64_t{count} * 12)));
  bytes.resize(file.read(at + 8, bytes.data(), bytes.size()));
  try {
    std::vector<LazChunk> chunks =
        decoded_table(bytes, count, header.laz->chunk_points == LazRecord::kAnyCount);
    place_chunks(chunks, header, at);
    return chunks;
  } catch (const DamagedChunk&) {
    refuse_table(header, "the table of its chunks is damaged");
  }
}

}  // namespace waymark::importers
