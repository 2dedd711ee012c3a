// SPDX-License-Identifier: Apache-2.0
#include "exporters/las_file.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/output_error.hpp"

namespace waymark::exporters {
namespace {

constexpr std::size_t kHeader = 375, kRecordHead = 54, kPoint = 30;
constexpr double kScale = 0.001;  // metres

template <class T>
void put(std::string& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

void put_text(std::string& bytes, std::size_t at, std::string_view text, std::size_t room) {
  std::memcpy(bytes.data() + at, text.data(), std::min(text.size(), room));
}

/// Writes the only variable length record: the CRS as OGC WKT.
std::string wkt_record(const Crs& crs) {
  if (crs.kind() == CrsKind::local) return "";
  const std::string wkt = (crs.wkt1().empty() ? crs.wkt2() : crs.wkt1()) + '\0';
  std::string record(kRecordHead, '\0');
  put_text(record, 2, "LASF_Projection", 16);
  put(record, 18, std::uint16_t{2112});
  put(record, 20, static_cast<std::uint16_t>(wkt.size()));
  put_text(record, 22, "OGC coordinate system WKT", 32);
  return record + wkt;
}

}  // namespace

struct LasFile::State {
  std::filesystem::path path;
  AtomicFile aside;
  std::ofstream file;
  std::string record, buffer;
  std::array<double, 3> origin{}, low{}, high{};
  std::array<std::uint64_t, 15> of_return{};
  std::uint64_t count = 0;

  State(std::filesystem::path final_path, const Crs& crs, double x, double y)
      : path(std::move(final_path)), aside(path), record(wkt_record(crs)), origin{x, y, 0} {
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
    file.open(aside.path(), std::ios::binary);
    file << std::string(kHeader, '\0') << record;
  }

  void flush() {
    file << buffer;
    buffer.clear();
    if (!file) fail_output(path, "the point cloud was not written");
  }

  std::string header() const {
    std::string h(kHeader, '\0');
    put_text(h, 0, "LASF", 4);
    put(h, 6, static_cast<std::uint16_t>(0x10 | 0x01));  // WKT; GPS time is standard
    h[24] = 1, h[25] = 4;
    put_text(h, 26, "Waymark testbed", 32);
    put_text(h, 58, "Waymark", 32);
    put(h, 90, std::uint16_t{1}),
        put(h, 92, std::uint16_t{2026});  // a fixed day, so that equal clouds give equal bytes
    put(h, 94, static_cast<std::uint16_t>(kHeader));
    put(h, 96, static_cast<std::uint32_t>(kHeader + record.size()));
    put(h, 100, static_cast<std::uint32_t>(record.empty() ? 0 : 1));
    h[104] = 6;
    put(h, 105, static_cast<std::uint16_t>(kPoint));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      put(h, 131 + 8 * axis, kScale);
      put(h, 155 + 8 * axis, origin[axis]);
      put(h, 179 + 16 * axis, count > 0 ? high[axis] : 0.0);
      put(h, 187 + 16 * axis, count > 0 ? low[axis] : 0.0);
    }
    put(h, 247, count);  // the legacy 32-bit counts stay 0 in point format 6
    for (std::size_t i = 0; i < of_return.size(); ++i) put(h, 255 + 8 * i, of_return[i]);
    return h;
  }
};

LasFile::LasFile(std::filesystem::path path, const Crs& crs, double origin_x, double origin_y)
    : state_(std::make_unique<State>(std::move(path), crs, std::floor(origin_x), std::floor(origin_y))) {}
LasFile::~LasFile() = default;

void LasFile::add(const LasReturn& point) {
  State& s = *state_;
  std::string record(kPoint, '\0');
  const std::array<double, 3> at{point.x, point.y, point.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double steps = std::round((at[axis] - s.origin[axis]) / kScale);
    if (!(std::abs(steps) < 2147483647))
      throw Error(ErrorCode::output, "a point is too far from the origin of the cloud", s.path);
    const auto stored = static_cast<std::int32_t>(steps);
    put(record, 4 * axis, stored);
    const double value = s.origin[axis] + kScale * stored;
    s.low[axis] = std::min(s.low[axis], value);
    s.high[axis] = std::max(s.high[axis], value);
  }
  put(record, 12, point.intensity);
  record[14] = static_cast<char>((point.number & 15) | (point.of & 15) << 4);
  record[16] = static_cast<char>(point.kind);
  put(record, 20, std::uint16_t{1});
  put(record, 22, point.time);
  s.buffer += record;
  ++s.count;
  if (point.number >= 1 && point.number <= 15) ++s.of_return[point.number - 1U];
  if (s.buffer.size() > 1 << 20) s.flush();
}

void LasFile::close() {
  State& s = *state_;
  s.flush();
  s.file.seekp(0);
  s.file << s.header();
  s.file.close();
  if (!s.file) fail_output(s.path, "the point cloud was not written");
  s.aside.commit();
}

}  // namespace waymark::exporters
