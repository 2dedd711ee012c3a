// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <string>
#include <vector>
namespace waymark::test {

/// Returns the folder of the image sets with known answers, beside the repository.
std::filesystem::path reconstruction_data();

/// Reads a table of numbers between commas, blanks and tabs. Rows that do not begin with a number are
/// skipped; words become NaN.
std::vector<std::vector<double>> number_rows(const std::filesystem::path& path);

/// Number as printed, with the rounding that its digits allow.
struct Printed {
  double value = 0;
  double rounding = 0;  ///< half a unit of the last digit
};

/// Returns the values ("Omega") and standard deviations ("Omega sd") of a report of the Damped Bundle
/// Adjustment Toolbox: by photo, from 1; the camera's own under 0.
std::map<int, std::map<std::string, Printed>> read_report(const std::filesystem::path& path);

/// Returns world_from_camera (OpenCV axes) of omega, phi, kappa: R = Rx Ry Rz with y up and z back, radians.
Eigen::Matrix3d rotation_of(const Eigen::Vector3d& opk);
/// Returns omega, phi, kappa, radians.
Eigen::Vector3d opk_of(const Eigen::Matrix3d& world_from_camera);
/// Returns the derivatives of omega, phi, kappa by a rotation about the camera's axes.
Eigen::Matrix3d opk_by_turn(const Eigen::Matrix3d& world_from_camera);

}  // namespace waymark::test
