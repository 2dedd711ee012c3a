// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>
#include "exporters/report/landmark_section.hpp"
namespace waymark {

/// Counts of values between edges; edges.size() = counts.size() + 1. The last bin includes its upper edge.
struct Histogram {
  std::vector<double> edges;
  std::vector<std::int64_t> counts;
  bool logarithmic = false;
};

/// Bins for finite values, at least one. Logarithmic for positive values of a ratio scale that span more than
/// a factor of 30; the edges are then equal ratios, else equal steps.
Histogram histogram_of(const std::vector<double>& values, Scale scale);

/// One figure per feature of which at least two values are known: bars, the median, and what is counted.
std::string histogram_figures(const LandmarkSection& section);

}  // namespace waymark
