// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "importers/logs/bag_messages.hpp"
#include "importers/logs/binary_number.hpp"

namespace waymark::importers {
namespace {

constexpr float kFarthestPoint = 1e4F;  // m; of any scanner

// sensor_msgs/msg/PointField: types 1 to 8.
constexpr std::array<NumberType, 9> kTypes{{{},
                                            {1, false, true},
                                            {1, false, false},
                                            {2, false, true},
                                            {2, false, false},
                                            {4, false, true},
                                            {4, false, false},
                                            {4, true, true},
                                            {8, true, true}}};

struct Field {
  std::size_t offset = 0;
  NumberType type;
};

struct PointFields {
  std::array<Field, 3> axes;
  Field intensity;  // of no size if there is none
};

PointFields read_fields(CdrReader& in) {
  constexpr std::size_t kMinField = 4 + 1 + 4 + 1 + 4;  // empty name, offset, type, count
  PointFields fields;
  bool is_named_intensity = false;
  for (std::size_t n = in.count(kMinField); n > 0; --n) {
    const std::string name = in.text();
    const std::size_t offset = in.number<std::uint32_t>();
    const std::size_t type = in.number<std::uint8_t>();
    in.number<std::uint32_t>();  // values of this field; those after the first are not read
    const bool is_intensity = name == "intensity" || (name == "reflectivity" && !is_named_intensity);
    if (is_intensity && type >= 1 && type < kTypes.size()) {
      fields.intensity = {offset, kTypes[type]};
      is_named_intensity = name == "intensity";
    }
    if (name != "x" && name != "y" && name != "z") continue;
    if (type < 1 || type >= kTypes.size())
      throw std::runtime_error(fmt::format("the field {} has the unknown type {}", name, type));
    fields.axes[static_cast<std::size_t>(name[0] - 'x')] = {offset, kTypes[type]};
  }
  for (const Field& axis : fields.axes)
    if (axis.type.size == 0) throw std::runtime_error("a point cloud lacks x, y or z");
  return fields;
}

}  // namespace

BagStamp read_cloud_stamp(const BagMessage& message) {
  CdrReader in(message.bytes);
  return read_stamp(in, message.received);
}

BagCloud read_cloud(const BagMessage& message) {
  CdrReader in(message.bytes);
  BagCloud cloud{.at = read_stamp(in, message.received), .points = {}, .intensities = {}};
  const std::size_t rows = in.number<std::uint32_t>(), columns = in.number<std::uint32_t>();
  PointFields fields = read_fields(in);
  const std::array<Field, 3>& axes = fields.axes;
  const bool swapped = in.number<std::uint8_t>() != 0;  // this machine is little endian
  const std::size_t step = in.number<std::uint32_t>();
  std::size_t row_step = in.number<std::uint32_t>();
  const std::size_t size = in.count(1);
  const std::string_view data = in.bytes(size);
  if (rows == 0 || columns == 0) return cloud;
  for (const Field& axis : axes)
    if (axis.offset > step || axis.type.size > step - axis.offset)
      throw std::runtime_error("a field of a point cloud reaches beyond its point");
  Field& intensity = fields.intensity;
  if (intensity.offset > step || intensity.type.size > step - intensity.offset) intensity = {};
  if (columns > size / step) throw std::runtime_error("a point cloud has fewer points than it states");
  if (row_step == 0 || rows == 1) row_step = columns * step;  // drivers of single rows leave it out
  if (row_step < columns * step || rows - 1 > (size - columns * step) / row_step)
    throw std::runtime_error("a point cloud has fewer rows than it states");
  cloud.points.reserve(rows * columns);
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c) {
      const char* point = data.data() + r * row_step + c * step;
      Eigen::Vector3f p;
      for (std::size_t k = 0; k < axes.size(); ++k)
        p(static_cast<Eigen::Index>(k)) =
            static_cast<float>(read_binary_number(point + axes[k].offset, axes[k].type, swapped));
      if (!p.allFinite()) continue;
      if (!(p.cwiseAbs().maxCoeff() < kFarthestPoint))
        throw std::runtime_error("a point is farther than 10 km: no metres of a scanner");
      cloud.points.push_back(p);
      if (intensity.type.size > 0)
        cloud.intensities.push_back(
            static_cast<float>(read_binary_number(point + intensity.offset, intensity.type, swapped)));
    }
  return cloud;
}

}  // namespace waymark::importers
