// SPDX-License-Identifier: Apache-2.0
#include "core/lower_case.hpp"

namespace waymark::inline core {

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

}  // namespace waymark::inline core
