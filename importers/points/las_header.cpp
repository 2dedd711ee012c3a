// SPDX-License-Identifier: Apache-2.0
#include "importers/points/las_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include "core/error.hpp"
#include "importers/points/laz/copc.hpp"
#include "importers/vsi_file.hpp"

namespace waymark::importers {
namespace {

constexpr std::array<int, 11> kMinLength{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
constexpr int kCompressed = 0x80;          // bit of the point format
constexpr std::size_t kHeaderBytes = 375;  // of LAS 1.4; older ones are shorter

[[noreturn]] void refuse(const std::string& path, const std::string& problem, const std::string& hint) {
  throw Error(ErrorCode::input, problem, path, hint);
}

template <class T>
T at(const std::vector<unsigned char>& bytes, std::size_t offset) {
  T value{};
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

std::vector<unsigned char> bytes_of(VsiFile& file, std::uint64_t offset, std::size_t count) {
  std::vector<unsigned char> bytes(count);
  bytes.resize(file.read(offset, bytes.data(), count));
  return bytes;
}

// Contents of the records that are read.
struct LasRecords {
  std::string wkt;
  int projected = 0, geographic = 0, linear_unit = 0, vertical_unit = 0, vertical = 0;
  std::optional<LazRecord> laz;
  std::optional<CopcRecord> copc;
};

void read_keys(const std::vector<unsigned char>& body, LasRecords& records) {
  if (body.size() < 8) return;
  const std::size_t count = at<std::uint16_t>(body, 6);
  for (std::size_t i = 0; i < count && 16 + 8 * i <= body.size(); ++i) {
    const auto key = at<std::uint16_t>(body, 8 + 8 * i), place = at<std::uint16_t>(body, 10 + 8 * i),
               value = at<std::uint16_t>(body, 14 + 8 * i);
    if (place != 0) continue;
    if (key == 2048) records.geographic = value;
    if (key == 3072) records.projected = value;
    if (key == 3076) records.linear_unit = value;
    if (key == 4096) records.vertical = value;
    if (key == 4099) records.vertical_unit = value;
  }
}

void read_record(VsiFile& file, const char* user, int id, std::uint64_t body, std::uint64_t length,
                 LasRecords& records) {
  const std::string_view owner(user, ::strnlen(user, 16));
  const bool projection = owner == "LASF_Projection", laz = owner == "laszip encoded" && id == 22204,
             copc = owner == "copc" && id == 1;
  if ((!projection && !laz && !copc) || length > (1U << 20)) return;
  const auto bytes = bytes_of(file, body, static_cast<std::size_t>(length));
  if (laz) records.laz = laz_record(bytes);
  if (copc) records.copc = copc_record(bytes);
  if (!projection) return;
  if (id == 34735) read_keys(bytes, records);
  if (id == 2112) {
    records.wkt.assign(bytes.begin(), bytes.end());
    records.wkt.erase(std::find(records.wkt.begin(), records.wkt.end(), '\0'), records.wkt.end());
  }
}

LasRecords read_records(VsiFile& file, const std::vector<unsigned char>& head, int minor) {
  LasRecords records;
  std::uint64_t offset = at<std::uint16_t>(head, 94);
  const std::uint64_t end = at<std::uint32_t>(head, 96);
  for (std::uint32_t i = 0; i < at<std::uint32_t>(head, 100) && offset + 54 <= end; ++i) {
    const auto record = bytes_of(file, offset, 54);
    if (record.size() < 54) break;
    const auto length = at<std::uint16_t>(record, 20);
    read_record(file, reinterpret_cast<const char*>(record.data() + 2), at<std::uint16_t>(record, 18),
                offset + 54, length, records);
    offset += 54U + length;
  }
  if (minor < 4 || head.size() < kHeaderBytes) return records;
  offset = at<std::uint64_t>(head, 235);
  for (std::uint32_t i = 0; i < at<std::uint32_t>(head, 243) && offset > 0 && i < 1000; ++i) {
    const auto record = bytes_of(file, offset, 60);
    if (record.size() < 60) break;
    const auto length = at<std::uint64_t>(record, 20);
    read_record(file, reinterpret_cast<const char*>(record.data() + 2), at<std::uint16_t>(record, 18),
                offset + 60, length, records);
    offset += 60 + length;
  }
  return records;
}

double metres_of_unit(int epsg) {
  return epsg == 9001 ? 1 : epsg == 9002 ? 0.3048 : epsg == 9003 ? 1200.0 / 3937 : 0;
}

// Returns the unit of a vertical CRS in WKT: the last unit named in it.
double vertical_unit_of(const std::string& wkt) {
  std::size_t start = wkt.find("VERT_CS");
  if (start == std::string::npos) start = wkt.find("VERTCRS");
  if (start == std::string::npos) return 0;
  const std::string part = wkt.substr(start);
  if (part.find("US survey foot") != std::string::npos || part.find("US_Foot") != std::string::npos ||
      part.find("foot_us") != std::string::npos || part.find("Foot_US") != std::string::npos)
    return 1200.0 / 3937;
  if (part.find("\"foot\"") != std::string::npos || part.find("\"Foot\"") != std::string::npos) return 0.3048;
  return 1;
}

void place(LasHeader& header, const LasRecords& records) {
  try {
    if (!records.wkt.empty())
      header.crs = Crs::from_text(records.wkt);
    else if (records.projected > 0 && records.projected < 32767)
      header.crs = Crs::from_text(fmt::format("EPSG:{}", records.projected));
    else if (records.projected == 0 && records.geographic > 0 && records.geographic < 32767)
      header.crs = Crs::from_text(fmt::format("EPSG:{}", records.geographic));
  } catch (const Error&) {  // a CRS unknown to PROJ counts as none
  }
  header.metres_per_height =
      records.wkt.empty() ? metres_of_unit(records.vertical_unit) : vertical_unit_of(records.wkt);
}

void check_format(LasHeader& header, const std::vector<unsigned char>& head) {
  const int format = head[104] & ~kCompressed;
  if (format > 10)
    refuse(header.path, fmt::format("point format {} is none of LAS 1.0 to 1.4 (0 to 10)", format),
           "is the file damaged?");
  header.point_format = format;
  header.point_length = at<std::uint16_t>(head, 105);
  const int min_length = kMinLength[static_cast<std::size_t>(format)];
  if (header.point_length < min_length)
    refuse(header.path,
           fmt::format("a point record of format {} has {} bytes at least, the header says {}", format,
                       min_length, header.point_length),
           "the header is damaged: write the file again from its source");
}

void count_points(LasHeader& header, const std::vector<unsigned char>& head, std::uint64_t size) {
  header.first_point = at<std::uint32_t>(head, 96);
  header.points = at<std::uint32_t>(head, 107);
  header.first_returns = at<std::uint32_t>(head, 111);
  if (header.minor_version >= 4 && head.size() >= kHeaderBytes)
    if (const auto count = at<std::uint64_t>(head, 247); count > 0) {
      header.points = count;
      header.first_returns = at<std::uint64_t>(head, 255);
    }
  if (head[104] & kCompressed) return;
  const auto length = static_cast<std::uint64_t>(header.point_length);
  const std::uint64_t there = size > header.first_point ? (size - header.first_point) / length : 0;
  if (header.points > there)
    refuse(
        header.path,
        fmt::format("the file is truncated: its header states {} points, it holds {}", header.points, there),
        "copy or download it again");
}

}  // namespace

LasHeader read_las_header(const std::string& path) {
  VsiFile file(path);
  LasHeader header;
  header.path = path;
  const std::vector<unsigned char> head = bytes_of(file, 0, kHeaderBytes);
  if (head.size() < 4 || std::memcmp(head.data(), "LASF", 4) != 0)
    refuse(path, head.empty() ? "the file is empty" : "the file is no LAS file: it does not begin with LASF",
           "--las takes LAS 1.0 to 1.4, LAZ and COPC; rasters are passed with --chm, or --dsm and --dtm");
  if (head.size() < 227) refuse(path, "the file ends within its header", "copy or download it again");
  header.minor_version = head[25];
  if (head[24] != 1 || header.minor_version > 4)
    refuse(path, fmt::format("LAS {}.{} is not known: 1.0 to 1.4 are", head[24], head[25]),
           "write it as LAS 1.4");
  check_format(header, head);
  for (std::size_t i = 0; i < 3; ++i) {
    header.scale[i] = at<double>(head, 131 + 8 * i);
    header.offset[i] = at<double>(head, 155 + 8 * i);
    header.high[i] = at<double>(head, 179 + 16 * i);
    header.low[i] = at<double>(head, 187 + 16 * i);
    if (!(std::abs(header.scale[i]) > 0) || !std::isfinite(header.scale[i]) ||
        !std::isfinite(header.offset[i]))
      refuse(path, fmt::format("coordinates would be {} times the stored number", header.scale[i]),
             "the header is damaged: write the file again from its source");
  }
  count_points(header, head, file.size());
  const LasRecords records = read_records(file, head, header.minor_version);
  place(header, records);
  if (head[104] & kCompressed) {
    header.laz = records.laz;
    check_laz(header);
    if (header.point_format >= 6 && header.point_format <= 8) header.copc = records.copc;
  }
  return header;
}

}  // namespace waymark::importers
