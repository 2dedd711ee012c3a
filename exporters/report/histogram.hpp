// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>
#include "exporters/report/landmark_section.hpp"
namespace waymark::exporters {

/// Counts of values between edges; edges.size() = counts.size() + 1. The last bin includes its upper edge.
struct Histogram {
  std::vector<double> edges;
  std::vector<std::int64_t> counts;
  bool logarithmic = false;
};

/// Computes at least one bin for finite values. Bins are logarithmic, with edges at equal ratios, for
/// positive values of a ratio scale that span more than a factor of 30; else they have equal width.
Histogram histogram_of(const std::vector<double>& values, Scale scale);

/// Returns one figure per feature with at least two known values: bars, the median, and the counts.
std::string histogram_figures(const LandmarkSection& section);

}  // namespace waymark::exporters
