// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "exporters/count_area.hpp"
#include "exporters/report/landmark_section.hpp"
namespace waymark {

/// Counts between diameters that grow by the square root of two, the bins of crater counting (Crater Analysis
/// Techniques Working Group 1979): 2^(k/2) km.
struct SizeBin {
  double from = 0, to = 0;  ///< metres
  std::int64_t count = 0;
  std::int64_t larger = 0;  ///< of at least `from`

  double middle() const;  ///< geometric
};
/// Of positive diameters in metres: from the bin of the smallest to that of the largest, empty ones too.
std::vector<SizeBin> size_bins(const std::vector<double>& diameters);

/// Craters per km2 and bin as relative to a population falling with the cube of the diameter:
/// R = D^3 N / (area (to - from)), D the geometric middle; km and km2.
double relative_density(const SizeBin& bin, double square_metres);

/// The size-frequency distribution of a bowl-shaped type: cumulative, and the R-plot where the area is known;
/// empty for other types and fewer than five of known size.
std::string size_frequency_figures(const LandmarkSection& section, const std::optional<CountArea>& area);

}  // namespace waymark
