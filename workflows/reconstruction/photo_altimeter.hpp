// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "pipeline/reconstruction/adjustment/observations.hpp"
#include "workflows/reconstruction/read_photos.hpp"
namespace waymark::workflows {

/// Heights of pictures by an altimeter. `image`: index into `Photos::photos`.
struct PhotoAltimeter {
  std::vector<pipeline::ObservedHeightAboveGround> above_ground = {};
  std::vector<pipeline::ObservedHeight> heights = {};  ///< in the heights of the map, without a common bias
  std::vector<std::string> warnings = {};              ///< readings of pictures that are not there
};

/// Reads an altimeter table (docs/reference/altimeter_table.md). Deviations that it lacks are 1 % of a height
/// above ground, at least 0.1 m, and 1 m of another height. Throws Error{input} as read_altimeter_table()
/// does, and if it names none of the pictures.
PhotoAltimeter photo_altimeter(const std::string& table, const Photos& photos);

}  // namespace waymark::workflows
