// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/photo_positions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/median.hpp"

namespace waymark::workflows {

double degrees_apart(const LonLat& a, const LonLat& b) {
  const double shrink = std::cos(std::clamp(b.lat, -90.0, 90.0) * std::numbers::pi / 180);
  return std::hypot(std::remainder(a.lon - b.lon, 360) * shrink, a.lat - b.lat);
}

std::optional<LonLat> middle_of_positions(const Photos& photos) {
  std::vector<double> lons, lats;
  for (const Photo& photo : photos.photos)
    if (const auto& at = photo.metadata.position) lons.push_back(at->lon), lats.push_back(at->lat);
  if (lons.empty()) return std::nullopt;
  return LonLat{median(std::move(lons)), median(std::move(lats))};
}

std::string cause_of_distance(const LonLat& stated, const LonLat& truth) {
  const std::pair<const char*, LonLat> causes[] = {
      {"latitude and longitude are exchanged in them", {stated.lat, stated.lon}},
      {"they name the wrong hemisphere of latitude", {stated.lon, -stated.lat}},
      {"they name the wrong hemisphere of longitude", {-stated.lon, stated.lat}}};
  for (const auto& [cause, corrected] : causes)
    if (degrees_apart(corrected, truth) < kLongestFlight) return cause;
  return "check the clock and the settings of the camera";
}

}  // namespace waymark::workflows
