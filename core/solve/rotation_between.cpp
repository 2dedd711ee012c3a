// SPDX-License-Identifier: Apache-2.0
#include "core/solve.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace waymark::inline core {

Eigen::Matrix3d rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to).toRotationMatrix();
}

}  // namespace waymark::inline core
