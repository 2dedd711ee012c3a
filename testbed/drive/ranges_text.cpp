// SPDX-License-Identifier: Apache-2.0
#include "testbed/drive/ranges_text.hpp"

#include <fmt/format.h>

namespace waymark::testbed {

std::string ranges_text(std::span<const float> ranges, int decimals) {
  std::string text;
  for (const float range : ranges) {
    if (!text.empty()) text += ',';
    text += range > 0 ? fmt::format("{:.{}f}", range, decimals) : "null";
  }
  return text;
}

}  // namespace waymark::testbed
