// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include "localization/detectors/cloud_bearings.hpp"
namespace waymark::localization {

/// A layer of an upright column as the scanner sees it.
struct ColumnLayer {
  double right = 0, left = 0;  ///< rad from the bearing of the column: its outermost points
  double low = 0, high = 0;    ///< tangents of elevations: of its lowest and highest point
};

/// Returns the fraction of the layers of a column that nearer things cut off. A pole stands before its
/// background; a strip of a wall is what nearer things, or nearer pieces of the wall, leave of it.
/// - A layer is cut off if the next columns of the scanner on one side end nearer at the same elevation.
/// - It is not if these end clearly nearer and those on the other side clearly farther: half of a pole is
///   hidden then. Beams without return show no background.
/// `range`: of the column, m. `step`: angle between columns of the scanner, rad; 0: unknown, nothing is cut
/// off.
double cut_off_fraction(std::span<const ColumnLayer> layers, const CloudBearings& cloud, double bearing,
                        double range, double step);

}  // namespace waymark::localization
