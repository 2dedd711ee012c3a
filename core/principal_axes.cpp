// SPDX-License-Identifier: Apache-2.0
#include "core/principal_axes.hpp"

#include <cmath>

namespace waymark::inline core {

Eigen::Vector2d PrincipalAxes::major_direction() const {
  return {std::cos(angle), std::sin(angle)};
}
Eigen::Vector2d PrincipalAxes::minor_direction() const {
  return {-std::sin(angle), std::cos(angle)};
}

PrincipalAxes principal_axes(const Eigen::Matrix2d& matrix) {
  const double xy = (matrix(0, 1) + matrix(1, 0)) / 2;
  const double middle = (matrix(0, 0) + matrix(1, 1)) / 2, half = (matrix(0, 0) - matrix(1, 1)) / 2;
  const double reach = std::hypot(half, xy);
  // -0 of xy with half < 0 would give -pi/2; adding 0 makes it +0.
  return {middle + reach, middle - reach, std::atan2(xy + 0.0, half) / 2};
}

}  // namespace waymark::inline core
