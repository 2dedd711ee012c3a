// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include "geo/body.hpp"
#include "workflows/reconstruction/read_photos.hpp"
namespace waymark::workflows {

/// Degrees between positions of one flight at most: no flight is that long.
inline constexpr double kLongestFlight = 1;

/// Returns the angle between two positions, degrees, in a plane that touches the body at `b`.
double degrees_apart(const LonLat& a, const LonLat& b);

/// Returns the medians of the pictures' longitudes and latitudes; `std::nullopt` without positions.
std::optional<LonLat> middle_of_positions(const Photos& photos);

/// Returns what is probably wrong with a stated position that is far from the true one: hemisphere, order, or
/// another cause.
std::string cause_of_distance(const LonLat& stated, const LonLat& truth);

}  // namespace waymark::workflows
