// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
namespace waymark::test {

/// A place and a heading, without the program's own arithmetic.
struct MadePose {
  double x = 0, y = 0, yaw = 0;

  MadePose operator*(const MadePose& step) const {
    return {x + std::cos(yaw) * step.x - std::sin(yaw) * step.y,
            y + std::sin(yaw) * step.x + std::cos(yaw) * step.y, std::remainder(yaw + step.yaw, 2 * M_PI)};
  }
  /// The other one, seen from here.
  MadePose to(const MadePose& other) const {
    const double dx = other.x - x, dy = other.y - y;
    return {std::cos(yaw) * dx + std::sin(yaw) * dy, std::cos(yaw) * dy - std::sin(yaw) * dx,
            std::remainder(other.yaw - yaw, 2 * M_PI)};
  }
  double away(const MadePose& other) const { return std::hypot(other.x - x, other.y - y); }
};

}  // namespace waymark::test
