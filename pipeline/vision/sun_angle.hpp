// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/units.hpp"
namespace waymark::pipeline {

/// Direction of the light, estimated from the image.
struct SunAngle {
  Radians angle;    ///< towards the sun, in the image from x (right) towards y (down), (-pi, pi]
  Radians sd;       ///< standard deviation of `angle`
  int shadows = 0;  ///< pairs of shadow and lit side that agree
};

}  // namespace waymark::pipeline
