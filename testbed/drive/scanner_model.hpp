// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include "core/options.hpp"
#include "core/units.hpp"
namespace waymark::testbed {

/// 3-D scanner that turns about the vertical, on a robot in a street or a hall.
struct ScannerModel {
  bool on = false;
  double every = 1;  ///< s between two turns
  std::int64_t rows = 32;
  Degrees lowest{-25}, highest{15};  ///< elevations of the rows
  Degrees step{0.4};                 ///< between columns
  double max_range = 60;             ///< metres
  double height = 1.8;               ///< metres above the ground
  double range_sd = 0.02;            ///< metres
  double dropouts = 0.02;            ///< fraction of beams without return
  bool intensities = true;           ///< log the strengths of the returns
};
void describe_scanner(ScannerModel& scanner, OptionVisitor& field);

}  // namespace waymark::testbed
