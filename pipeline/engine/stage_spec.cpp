// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/stage_spec.hpp"

namespace waymark::pipeline {

std::string to_string(Scope scope) {
  constexpr const char* kNames[] = {"map", "tile", "image"};
  return kNames[static_cast<int>(scope)];
}

}  // namespace waymark::pipeline
