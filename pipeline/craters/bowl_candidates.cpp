// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/bowl_candidates.hpp"

namespace waymark::pipeline {

std::vector<CraterCandidate> bowl_candidates(const Pixels& image, const BowlSearch& search) {
  const auto shapes_of = [&](const std::vector<BowlLight>& lights) {
    return [&search, lights](double diameter) {
      std::vector<Pixels> shapes;
      for (const BowlLight light : lights) shapes.push_back(bowl_template(diameter, search.sun_angle, light));
      return shapes;
    };
  };
  std::vector<BowlLight> large = search.lights;
  large.insert(large.end(), search.filled.begin(), search.filled.end());
  return shape_candidates(
      image, {.limits = search.limits, .shapes = shapes_of(search.lights), .large_shapes = shapes_of(large)});
}

}  // namespace waymark::pipeline
