// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "pipeline/forest/stand_polygon.hpp"

namespace waymark::test {

/// Returns a square of the given side whose south-western corner lies at (x, y); metres.
inline pipeline::StandPolygon square_stand(double x, double y, double side) {
  return {{{{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}}}};
}

}  // namespace waymark::test
