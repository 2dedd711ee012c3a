// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include "localization/global/pose_finder.hpp"
#include "localization/identification/landmark_grid.hpp"
namespace waymark::localization {

/// Finds the pose of a robot from ranges to identified landmarks along its drive (trilateration with
/// odometry).
/// - Poses of all headings are refined by robust least squares. The candidates are the distinct minima.
/// - The best is accepted if it fits, if its covariance is small, and if no other minimum explains the same
///   ranges nearly as well. Ranges to two landmarks along a straight line fit the mirrored pose: none is
///   accepted.
/// - Errors of odometry and map are common to several ranges, and are counted so.
PoseSearchResult resect(std::span<const EarlierRange> ranges, const LandmarkGrid& map);

}  // namespace waymark::localization
