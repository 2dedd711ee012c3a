// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>
namespace waymark::importers {

/// Heights that instruments gave for an image, metres.
struct AltimeterReading {
  std::string image = {};                   ///< file name
  std::optional<double> above_ground = {};  ///< of the camera above the ground straight below it
  std::optional<double> height = {};        ///< of the camera, in the heights of the map
  std::optional<double> sd = {};            ///< of either; none: unknown
};

/// Reads a table with the columns image, above_ground or height or both, and optionally sd. Empty cells are
/// unknown. Throws Error{input} with file and line for a missing column or number and two rows of one image;
/// also for a height above ground or a standard deviation that is not above 0.
std::vector<AltimeterReading> read_altimeter_table(const std::string& path);

}  // namespace waymark::importers
