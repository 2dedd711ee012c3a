// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "core/random.hpp"
#include "localization/laser_scan.hpp"
#include "testbed/drive/scanner_model.hpp"
#include "testbed/town/town.hpp"
namespace waymark::testbed {

/// Returns one turn of a 3-D scanner above the middle of a robot, with intensities from 0 to 1. Two fifths of
/// the glass of windows returns nothing, the rest lies 0.15 m behind the facade; beams end at random in
/// crowns of trees.
localization::PointCloud turn_of_scanner(const Town& town, const localization::Pose2& robot, double t,
                                         const ScannerModel& scanner, Random& random);

/// Returns the points as a file of KITTI: little-endian float32 x, y, z, intensity.
std::string kitti_bytes(const localization::PointCloud& cloud);

/// Returns the strength of a return, from 0 to 1, with noise.
float strength_of(const TownHit& hit, Random& random);

}  // namespace waymark::testbed
