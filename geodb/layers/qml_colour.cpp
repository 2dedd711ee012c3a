// SPDX-License-Identifier: Apache-2.0
#include "geodb/layers/qml_colour.hpp"

#include <fmt/format.h>

#include <charconv>

namespace waymark::geodb {

std::string qml_colour(const std::string& colour, double opacity) {
  unsigned value = 0x888888;
  if (colour.size() == 7) std::from_chars(colour.data() + 1, colour.data() + 7, value, 16);
  return fmt::format("{},{},{},{:.0f}", value >> 16 & 255, value >> 8 & 255, value & 255, 255 * opacity);
}

}  // namespace waymark::geodb
