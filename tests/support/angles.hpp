// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <numbers>

namespace waymark::test {

// Radians.
inline constexpr double kDegree = std::numbers::pi / 180;
inline constexpr double kRightAngle = std::numbers::pi / 2;
inline constexpr double kFullTurn = 2 * std::numbers::pi;

}  // namespace waymark::test
