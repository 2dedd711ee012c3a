// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "localization/laser_scan.hpp"
namespace waymark::localization {

/// Returns the angle between columns of a 3-D scan, radians: the median between neighbours of a row. 0 if
/// the points are in no rows, as after a rotation. Looks at an eighth of the rows.
double column_step(const PointCloud& cloud);

}  // namespace waymark::localization
