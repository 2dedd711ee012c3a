// SPDX-License-Identifier: Apache-2.0
#include <waymark/plug_in.hpp>

void waymark_plug_in(waymark::workflows::PlugIn& to) {
  to.image_detectors.add(
      {.name = "ghosts", .summary = "Nothing", .type = "ghost", .methods = {{"stare"}}, .make = [] {
         return waymark::workflows::ImageDetector{};
       }});
}
