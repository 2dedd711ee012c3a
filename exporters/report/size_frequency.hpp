// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "exporters/report/counting_area.hpp"
#include "exporters/report/landmark_section.hpp"
namespace waymark::exporters {

/// A bin of diameters for crater counting, growing by the square root of two (Crater Analysis Techniques
/// Working Group 1979): 2^(k/2) km.
struct SizeBin {
  double from = 0, to = 0;  ///< metres
  std::int64_t count = 0;
  std::int64_t larger = 0;  ///< of at least `from`

  double middle() const;  ///< geometric
};
/// Bins positive diameters in metres, from the bin of the smallest to that of the largest, empty ones
/// included.
std::vector<SizeBin> size_bins(const std::vector<double>& diameters);

/// Returns the crater density relative to a population falling with the cube of the diameter: R = D^3 N /
/// (area (to - from)), D the geometric middle; km and km2.
double relative_density(const SizeBin& bin, double square_metres);

/// Returns the size-frequency distribution of a bowl-shaped type: cumulative, and the R-plot if the area is
/// known. Empty for other types and for fewer than five landmarks of known size.
std::string size_frequency_figures(const LandmarkSection& section, const std::optional<CountingArea>& area);

}  // namespace waymark::exporters
