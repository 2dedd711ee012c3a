// SPDX-License-Identifier: Apache-2.0
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/random.hpp"
#include "testbed/landing/relief.hpp"

namespace waymark::testbed {

Grid<float> add_outcrops(Grid<float>& heights, const SiteModel& ground, const NodeGrid& nodes,
                         std::uint64_t seed) {
  const OutcropModel& law = ground.outcrops;
  Grid<float> cover(nodes.columns, nodes.rows, 0.0F);
  if (!(law.cover > 0)) return cover;
  NodeGrid about_middle = nodes;
  about_middle.x0 -= ground.east;
  about_middle.y0 -= ground.north;
  const auto noise_seed = [seed](std::string_view name) {
    return static_cast<std::uint32_t>(named_seed(seed, name));
  };
  const Grid<float> fields = fractal_grid({.longest = law.longest,
                                           .shortest = std::max(2 * ground.cell, law.longest / 12),
                                           .amplitude = 1,
                                           .hurst = 1.1,
                                           .seed = noise_seed("outcrops")},
                                          about_middle);
  std::vector<float> sorted(fields.cells().begin(), fields.cells().end());
  const auto nth =
      static_cast<std::ptrdiff_t>(std::clamp(1 - law.cover, 0.0, 1.0) * double(sorted.size() - 1));
  std::nth_element(sorted.begin(), sorted.begin() + nth, sorted.end());
  const double threshold = double(sorted[static_cast<std::size_t>(nth)]);

  const Fractal knobs{.longest = law.longest / 10,
                      .shortest = 2 * ground.cell,
                      .amplitude = 0.5,
                      .hurst = 0.9,
                      .seed = noise_seed("outcrop knobs")};
  const Grid<float> rough = fractal_grid(knobs, about_middle);
  tbb::parallel_for(std::int64_t{0}, nodes.rows, [&](std::int64_t j) {
    for (std::int64_t i = 0; i < nodes.columns; ++i) {
      // Scarp at the border, knobs and hollows on top, ridges where the noise changes sign.
      const double inside = std::clamp((double(fields(i, j)) - threshold) / 0.12, 0.0, 1.0);
      if (!(inside > 0)) continue;
      const double edge = inside * inside * (3 - 2 * inside);
      const double knob = 1 - std::min(1.5, 2 * std::abs(double(rough(i, j))));
      heights(i, j) += static_cast<float>(law.height * edge * (0.8 + 0.2 * knob));
      cover(i, j) = static_cast<float>(edge * (0.75 + 0.25 * knob));
    }
  });
  return cover;
}

}  // namespace waymark::testbed
