// SPDX-License-Identifier: Apache-2.0
#include "apps/level_ground.hpp"

#include <algorithm>

namespace waymark {

void ask_for_metres(Pipeline& pipeline) {
  const auto has = [&](const char* name) {
    return std::ranges::any_of(pipeline.steps(), [&](const auto& step) { return step->spec().name == name; });
  };
  if (has("load_dem") && has("load_images")) pipeline.set("load_dem.metric=true");
}

}  // namespace waymark
