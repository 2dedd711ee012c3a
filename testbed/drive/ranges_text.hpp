// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>
#include <span>
#include <string>
namespace waymark::testbed {

/// Returns ranges or depths (metres) as the items of a JSON list: null where there is no return.
inline std::string ranges_text(std::span<const float> ranges, int decimals) {
  std::string text;
  for (const float range : ranges) {
    if (!text.empty()) text += ',';
    text += range > 0 ? fmt::format("{:.{}f}", range, decimals) : "null";
  }
  return text;
}

}  // namespace waymark::testbed
