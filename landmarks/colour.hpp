// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>
namespace waymark::inline landmarks {

/// Returns true for a colour of a map symbol: "#rrggbb".
inline bool is_colour(std::string_view text) {
  return text.size() == 7 && text[0] == '#' &&
         text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string_view::npos;
}

}  // namespace waymark::inline landmarks
