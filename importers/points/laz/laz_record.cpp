// SPDX-License-Identifier: Apache-2.0
#include "importers/points/laz/laz_record.hpp"

#include <fmt/format.h>

#include <cstring>
#include <numeric>

#include "core/error.hpp"
#include "importers/points/las_header.hpp"

namespace waymark::importers {
namespace {

constexpr std::size_t kFixedBytes = 34, kItemBytes = 6;

template <class T>
T number_at(const std::vector<unsigned char>& bytes, std::size_t offset) {
  T value{};
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

[[noreturn]] void refuse_laz(const LasHeader& header, const std::string& problem) {
  throw Error(ErrorCode::input, problem, header.path,
              "write the file again from its source, as LAZ of now or as LAS");
}

// Returns the parts that a point format has.
std::vector<LazItem> items_of_format(int format, int length) {
  const bool layered = format >= 6;
  const bool colours = format == 2 || format == 3 || format == 5 || format == 7;
  std::vector<LazItem> items;
  items.push_back(layered ? LazItem{LazType::point14, 30, 3} : LazItem{LazType::point10, 20, 2});
  if (!layered && format != 0 && format != 2) items.push_back({LazType::gps_time, 8, 2});
  if (colours)
    items.push_back(
        {layered ? LazType::rgb14 : LazType::rgb12, 6, layered ? std::uint16_t{3} : std::uint16_t{2}});
  if (format == 8 || format == 10) items.push_back({LazType::rgbnir14, 8, 3});
  if (format == 4 || format == 5) items.push_back({LazType::wave13, 29, 1});
  if (format == 9 || format == 10) items.push_back({LazType::wave14, 29, 3});
  for (const LazItem& item : items) length -= item.size;
  if (length > 0)
    items.push_back({layered ? LazType::bytes14 : LazType::bytes, static_cast<std::uint16_t>(length),
                     layered ? std::uint16_t{3} : std::uint16_t{2}});
  return items;
}

}  // namespace

LazRecord laz_record(const std::vector<unsigned char>& body) {
  LazRecord record;
  if (body.size() < kFixedBytes) return record;
  record.compressor = number_at<std::uint16_t>(body, 0);
  record.coder = number_at<std::uint16_t>(body, 2);
  record.chunk_points = number_at<std::uint32_t>(body, 12);
  const std::size_t count = number_at<std::uint16_t>(body, 32);
  if (body.size() < kFixedBytes + count * kItemBytes) return record;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = kFixedBytes + i * kItemBytes;
    record.items.push_back({static_cast<LazType>(number_at<std::uint16_t>(body, at)),
                            number_at<std::uint16_t>(body, at + 2), number_at<std::uint16_t>(body, at + 4)});
  }
  return record;
}

void check_laz(const LasHeader& header) {
  if (!header.laz)
    refuse_laz(header, "the points are compressed (LAZ), but the record that says how is missing");
  const LazRecord& record = *header.laz;
  if (record.compressor < 1 || record.compressor > 3 || record.coder != 0)
    refuse_laz(header, fmt::format("the points are compressed by an unknown method (compressor {}, coder {})",
                                   record.compressor, record.coder));
  if ((record.compressor == 3) != (header.point_format >= 6))
    refuse_laz(header, fmt::format("compressor {} is not for point format {}", record.compressor,
                                   header.point_format));
  if (record.compressor != 1 && record.chunk_points == 0)
    refuse_laz(header, "the record of the compression states chunks of 0 points");
  const std::vector<LazItem> expected = items_of_format(header.point_format, header.point_length);
  const bool alike =
      std::equal(expected.begin(), expected.end(), record.items.begin(), record.items.end(),
                 [](const LazItem& a, const LazItem& b) { return a.type == b.type && a.size == b.size; });
  if (!alike)
    refuse_laz(header, fmt::format("the record of the compression does not describe points of format {} with "
                                   "{} bytes",
                                   header.point_format, header.point_length));
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const int is = record.items[i].version, can = expected[i].version;
    if (is != can && !(can == 3 && is == 4))
      refuse_laz(header, fmt::format("the points are compressed in version {} of the format; {} can be read",
                                     is, can == 3 ? "3 and 4" : fmt::format("{}", can)));
  }
}

}  // namespace waymark::importers
