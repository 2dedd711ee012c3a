// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/bowl_candidates.hpp"

#include "pipeline/craters/bowl_template.hpp"
#include "pipeline/craters/shape_search.hpp"

namespace waymark::pipeline {

std::vector<CraterCandidate> bowl_candidates(const Pixels& image, const BowlSearch& search) {
  const auto shapes = [&](double diameter) {
    std::vector<Pixels> lights;
    for (const BowlLight light : search.lights)
      lights.push_back(bowl_template(diameter, search.sun_angle, light));
    return lights;
  };
  return shape_candidates(image, {.min_diameter = search.min_diameter,
                                  .max_diameter = search.max_diameter,
                                  .min_correlation = search.min_correlation,
                                  .shapes = shapes});
}

}  // namespace waymark::pipeline
