// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/line_sighting.hpp"

#include <cmath>

namespace waymark::localization {

std::optional<LineType> line_type(const TypeRegistry& types, std::string_view name) {
  const LandmarkType* const type = types.find(name);
  const auto line = type ? line_features(*type) : std::nullopt;
  if (!line) return {};
  return LineType{types.id(name), line->direction};
}

SeenLandmark sighting_of_line(const SeenLine& line, const LineType& type, double confidence) {
  const Eigen::Vector2d along(-line.normal.y(), line.normal.x());
  const double middle = along.dot(line.centre);  // from the foot
  SeenLandmark s;
  s.type = type.type;
  s.range = -line.normal.dot(line.centre);
  s.range_sd = std::sqrt(line.centre_variance + middle * middle * line.angle_variance);
  s.extent = {middle + line.begin, middle + line.end, middle};
  s.features.value[type.direction] = std::atan2(line.normal.y(), line.normal.x());
  s.features.variance[type.direction] = line.angle_variance;
  s.confidence = confidence;
  return s;
}

}  // namespace waymark::localization
