// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/find_rocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "pipeline/rocks/find_classic_rocks.hpp"
#include "pipeline/rocks/find_shadow_rocks.hpp"
#include "pipeline/rocks/rock_sun_angle.hpp"
namespace waymark::pipeline {
namespace {

void check(const RockSearch& search) {
  const auto refuse = [](const std::string& problem, const std::string& hint) {
    throw Error(ErrorCode::usage, "cannot look for rocks: " + problem, "", hint);
  };
  if (search.sun_angle && !std::isfinite(search.sun_angle->value))
    refuse("the direction of the light in the image is not a number",
           "omit it to have it estimated from the image");
  if (search.sun_elevation) {
    const double degrees = to_degrees(*search.sun_elevation).value;
    if (!(degrees > 0))
      refuse(fmt::format("the sun elevation is {:g} degrees, not above the horizon", degrees),
             "give an elevation above 0 degrees; check the frame and the time of the sun");
    if (!(degrees < 90))
      refuse(fmt::format("the sun elevation is {:g} degrees", degrees),
             "give an elevation below 90 degrees: a sun at the zenith casts no shadows");
  }
  if (!(search.min_diameter > 0) || !(search.max_diameter > search.min_diameter))
    refuse(fmt::format("diameters from {:g} to {:g} pixels are not a range", search.min_diameter,
                       search.max_diameter),
           "give 0 < smallest < largest");
  if (!(search.min_confidence >= 0 && search.min_confidence <= 1))
    refuse(fmt::format("min_confidence is {:g}, not a probability", search.min_confidence),
           "give a value between 0 and 1");
  if (!(search.blur >= 0 && search.blur < 10))
    refuse(fmt::format("blur is {:g} pixels", search.blur),
           "give a standard deviation from 0 to 10; 0: unknown");
}

}  // namespace

RocksFound search_rocks(const Pixels& image, const RockSearch& search) {
  check(search);
  std::optional<Radians> sun_angle = search.sun_angle;
  if (!sun_angle)
    if (const auto seen = estimate_rock_sun_angle(image, search.crater_sun)) sun_angle = seen->angle;
  if (!sun_angle) return {};
  RocksFound found = search.method == RockMethod::classic
                         ? RocksFound{.rocks = find_classic_rocks(image, search, *sun_angle),
                                      .light = sun_angle,
                                      .coherence = {}}
                         : find_shadow_rocks(image, search, *sun_angle);
  std::sort(found.rocks.begin(), found.rocks.end(), [](const Detection& a, const Detection& b) {
    if (a.confidence != b.confidence) return a.confidence > b.confidence;
    return a.outline.y != b.outline.y ? a.outline.y < b.outline.y : a.outline.x < b.outline.x;
  });
  return found;
}

std::vector<Detection> find_rocks(const Pixels& image, const RockSearch& search) {
  return search_rocks(image, search).rocks;
}

}  // namespace waymark::pipeline
