// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/position_bias.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/rocks/rock_evidence.hpp"
namespace waymark::pipeline {
namespace {

// Range of the data of the fit; the polynomial is not extrapolated.
constexpr double kMinDiameter = 2, kMaxDiameter = 40;            // pixels of the scale
constexpr double kMinTanElevation = 0.25, kMaxTanElevation = 2;  // 14 and 63 degrees
constexpr double kMaxDisplacement = 2;                           // of the top, position units

}  // namespace

double position_bias(const PositionBiasInput& rock) {
  const double unit = position_unit(rock.radius);
  const double size = std::log(std::clamp(2 * rock.radius, kMinDiameter, kMaxDiameter) / 4);
  const double sun = std::clamp(rock.tan_elevation, kMinTanElevation, kMaxTanElevation) - 0.8;
  const double top = std::clamp(rock.displacement * rock.height / unit, -kMaxDisplacement, kMaxDisplacement);
  return unit * (-0.061 + 0.001 * size - 0.088 * sun + 0.060 * size * sun + 0.079 * size * size +
                 0.170 * sun * sun + 0.185 * top);
}

}  // namespace waymark::pipeline
