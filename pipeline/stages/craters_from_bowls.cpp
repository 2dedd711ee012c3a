// SPDX-License-Identifier: Apache-2.0
#include "pipeline/stages/craters_in_image.hpp"

namespace waymark::pipeline {
namespace {

struct CratersFromBowls : CratersInImage<CraterMethod::bowl> {
  static StageSpec spec() {
    return make_spec("craters_from_bowls",
                     "Finds craters in an image by shaded bowls, refined rims and a trained model", 5);
  }
};

}  // namespace

void register_stage_craters_from_bowls(Registry& registry);
void register_stage_craters_from_bowls(Registry& registry) {
  registry.add<CratersFromBowls>();
}

}  // namespace waymark::pipeline
