// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/crown_layer.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "geodb/hilbert_ranges.hpp"

namespace waymark::workflows {
namespace {

using Tables = std::vector<pipeline::RunResult::Reader<pipeline::CrownTable>>;
constexpr std::size_t kAtOnce = 100'000;

geodb::Shape shape_of(pipeline::CrownShape crown) {
  return {.parts = {{.outer = std::move(crown.ring)}},
          .values = {crown.uid.empty() ? AttributeValue() : AttributeValue(crown.uid), crown.source,
                     crown.height, crown.area, crown.diameter}};
}

void make_shapes(const Tables& tables, const std::function<void(const geodb::Shape&)>& take) {
  const auto places = [&](std::size_t table, const auto& look) {
    const auto crowns = tables[table]();
    for (std::size_t row = 0; row < crowns->size(); ++row) look(crowns->top(row));
  };
  geodb::Envelope extent;
  for (std::size_t table = 0; table < tables.size(); ++table)
    places(table, [&](const Eigen::Vector2d& top) { extent.add(top.x(), top.y()); });
  struct Place {
    std::uint32_t along = 0;
    std::size_t row = 0;
    std::shared_ptr<const pipeline::CrownTable> table;
  };
  for (const geodb::HilbertRange& range :
       geodb::divide_hilbert_curve(tables.size(), places, extent, kAtOnce)) {
    std::vector<Place> order;
    for (const std::uint32_t table : range.parts) {
      const auto crowns = tables[table]();
      for (std::size_t row = 0; row < crowns->size(); ++row)
        if (const std::uint32_t along = geodb::hilbert_position(crowns->top(row), extent);
            range.contains(along))
          order.push_back({along, row, crowns});
    }
    std::ranges::sort(order, [](const Place& a, const Place& b) {
      return a.along != b.along ? a.along < b.along : a.table->uid(a.row) < b.table->uid(b.row);
    });
    for (const Place& place : order) take(shape_of(place.table->at(place.row)));
  }
}

}  // namespace

geodb::ShapeLayer crown_layer(Tables tables) {
  using Kind = AttributeSpec::Kind;
  return {.name = "crown",
          .summary = "Crowns of the trees, seen from above",
          .kind = geodb::ShapeKind::polygon,
          .columns = {{"uid", "", Kind::text, "The tree in layer tree; empty where it was not kept"},
                      {"source", "", Kind::text, "Canopy model it was drawn on"},
                      {"height", "m", Kind::real, "Height of the tree"},
                      {"area", "m2", Kind::real, "Area"},
                      {"diameter", "m", Kind::real, "Diameter of the circle of that area"}},
          .style = {.colour = "#1b5e20", .fill = "#66bb6a", .fill_opacity = 0.3, .width = 0.2},
          .generator = [held = std::make_shared<const Tables>(std::move(tables))](const auto& take) {
            make_shapes(*held, take);
          }};
}

}  // namespace waymark::workflows
