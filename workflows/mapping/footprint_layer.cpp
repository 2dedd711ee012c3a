// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/footprint_layer.hpp"

#include <algorithm>
#include <numbers>
#include <tuple>
#include <utility>

#include "geodb/hilbert_ranges.hpp"

namespace waymark::workflows {

geodb::ShapeLayer footprint_layer(std::vector<pipeline::BuildingOutline> footprints) {
  using Kind = AttributeSpec::Kind;
  geodb::Envelope extent;
  for (const pipeline::BuildingOutline& f : footprints) extent.add(f.rings[0][0].x(), f.rings[0][0].y());
  std::ranges::sort(footprints, {}, [&](const pipeline::BuildingOutline& f) {
    return std::tuple(geodb::hilbert_position(f.rings[0][0], extent), std::string_view(f.uid));
  });
  geodb::ShapeLayer layer{
      .name = "footprint",
      .summary = "Outlines of the roofs of buildings, seen from above",
      .kind = geodb::ShapeKind::polygon,
      .columns = {{"uid", "", Kind::text, "The building in layer building"},
                  {"source", "", Kind::text, "Survey it was found in"},
                  {"height", "m", Kind::real, "Ground to the highest edge of the roof"},
                  {"area", "m2", Kind::real, "Area without courtyards"},
                  {"roof", "", Kind::text, "flat, shed, gabled, hipped or complex"},
                  {"slope", "deg", Kind::real, "Mean slope of the roof's planes by their area"},
                  {"outline", "", Kind::text, "regular: fitted walls; cells: along cells, so without walls"},
                  {"wall_sd", "m", Kind::real, "Mean standard deviation of the walls across their direction"},
                  {"density", "1/m2", Kind::real, "Last returns on the roof"},
                  {"confidence", "", Kind::real, "Probability that it is a building"}},
      .style = {.colour = "#5d4037", .fill = "#a1887f", .fill_opacity = 0.4, .width = 0.3}};
  for (pipeline::BuildingOutline& f : footprints) {
    geodb::ShapePart part{.outer = std::move(f.rings[0])};
    for (std::size_t i = 1; i < f.rings.size(); ++i) part.holes.push_back(std::move(f.rings[i]));
    layer.rows.push_back(
        {.parts = {std::move(part)},
         .values = {f.uid, f.source, f.height, f.area, f.roof, f.slope * 180 / std::numbers::pi, f.outline,
                    f.wall_sd, f.density, f.confidence}});
  }
  return layer;
}

}  // namespace waymark::workflows
