// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string_view>
#include "landmarks/landmark_type.hpp"
#include "localization/sighting.hpp"
namespace waymark::localization {

/// The seen piece of a straight line in the frame of the sensor, metres.
struct SeenLine {
  Eigen::Vector2d centre;                          ///< on the line
  Eigen::Vector2d normal;                          ///< unit vector to the side of the sensor
  double begin = 0, end = 0;                       ///< ends from the centre, to the left of the normal
  double centre_variance = 0, angle_variance = 0;  ///< m^2 across it, rad^2; independent
};

/// A type of lines of a map, and its feature for the direction of the normal.
struct LineType {
  TypeId type = 0;
  std::size_t direction = 0;
};

/// Returns the type of a map; `std::nullopt` if it has none of that name, or one of points.
std::optional<LineType> line_type(const TypeRegistry& types, std::string_view name);

/// Returns the sighting of a line: its distance, direction and extent.
SeenLandmark sighting_of_line(const SeenLine& line, const LineType& type, double confidence);

}  // namespace waymark::localization
