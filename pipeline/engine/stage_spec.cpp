// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/stage_spec.hpp"

namespace waymark {

std::string to_string(Scope scope) {
  return scope == Scope::map ? "map" : "tile";
}

}  // namespace waymark
