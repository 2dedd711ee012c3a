// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
namespace waymark::testbed {

/// Return of an airborne laser scanner. Metres, GridFrame.
struct LaserReturn {
  double x = 0, y = 0, z = 0;
  std::uint8_t number = 1, of = 1;  ///< return `number` of `of`, from 1
  std::uint8_t kind = 1;  ///< ASPRS class: 2 ground, 3 low (< 2 m), 4 medium (< 5 m), 5 high vegetation
  std::uint16_t intensity = 0;
  double time = 0;  ///< seconds
};

}  // namespace waymark::testbed
