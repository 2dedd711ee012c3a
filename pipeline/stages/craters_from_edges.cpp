// SPDX-License-Identifier: Apache-2.0
#include "pipeline/stages/craters_in_image.hpp"

namespace waymark::pipeline {
namespace {

struct CratersFromEdges : CratersInImage<CraterMethod::edges> {
  static StageSpec spec() {
    return make_spec("craters_from_edges",
                     "Finds craters in an image by pairing lit and shaded rim edges along the light", 3);
  }
};

}  // namespace

void register_stage_craters_from_edges(Registry& registry);
void register_stage_craters_from_edges(Registry& registry) {
  registry.add<CratersFromEdges>();
}

}  // namespace waymark::pipeline
