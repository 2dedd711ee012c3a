// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
namespace waymark::workflows {

/// Returns the name, or the name with the first suffix "-2", "-3", ... that is not taken.
template <class Taken>
std::string unused_name(const std::string& name, const char* separator, const Taken& taken) {
  std::string candidate = name;
  for (int n = 2; taken(candidate); ++n) candidate = name + separator + std::to_string(n);
  return candidate;
}

}  // namespace waymark::workflows
