// SPDX-License-Identifier: Apache-2.0
#include "geo/sun.hpp"

#include <cmath>

namespace waymark::inline geo {

Direction<GridFrame> sun_direction(const Sun& sun) {
  const double azimuth = to_radians(sun.azimuth).value, elevation = to_radians(sun.elevation).value;
  const double level = std::cos(elevation);
  return {{level * std::sin(azimuth), level * std::cos(azimuth), std::sin(elevation)}};
}

}  // namespace waymark::inline geo
