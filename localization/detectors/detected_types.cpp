// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/detected_types.hpp"

namespace waymark::localization {

DetectedTypes detected_types(const TypeRegistry& types) {
  const auto type = [&](const char* name) {
    return types.find(name) ? std::optional<TypeId>(types.id(name)) : std::nullopt;
  };
  return {.tree = type("tree"), .rock = type("rock"), .mountain_top = type("mountain_top")};
}

}  // namespace waymark::localization
