// SPDX-License-Identifier: Apache-2.0
#include "workflows/forest/stand_areas.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"
#include "importers/tables/stand_outlines.hpp"

namespace waymark::workflows {
namespace {

pipeline::StandPolygon in_metres(const std::vector<geodb::ShapePart>& outline, double unit) {
  pipeline::StandPolygon polygon;
  const auto add = [&](const std::vector<Eigen::Vector2d>& ring) {
    auto& corners = polygon.rings.emplace_back();
    for (const auto& corner : ring) corners.push_back(corner * unit);
    if (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
  };
  for (const geodb::ShapePart& part : outline) {
    add(part.outer);
    for (const auto& hole : part.holes) add(hole);
  }
  return polygon;
}

/// Returns the whole map as one stand.
NamedStand whole_map(const geodb::MapStore& map, const TreeReader& trees,
                     std::vector<std::string>& warnings) {
  NamedStand whole{.name = "all", .species = {}, .polygon = {}, .outline = {}};
  for (const std::string& layer : geodb::shape_layers(map.path()))
    if (layer == "survey")
      for (const geodb::Shape& row : geodb::read_shape_layer(map.path(), layer).rows)
        whole.outline.insert(whole.outline.end(), row.parts.begin(), row.parts.end());
  whole.polygon = in_metres(whole.outline, trees.unit());
  if (!whole.polygon.rings.empty()) return whole;
  whole.polygon = pipeline::estimate_sampled_area(trees.positions());
  if (whole.polygon.rings.empty())
    throw Error(ErrorCode::input, "the map's trees span no area, so the size of the stand is unknown",
                map.path().string(), "give its outline: --stands POLYGONS");
  geodb::ShapePart part;
  for (const auto& corner : whole.polygon.rings[0]) part.outer.push_back(corner / trees.unit());
  whole.outline = {part};
  warnings.push_back(
      fmt::format("the map does not say which area was surveyed: taken to be the hull of its trees, widened "
                  "to {:.2f} ha; --stands gives it exactly",
                  pipeline::area(whole.polygon) / 1e4));
  return whole;
}

/// Returns cells at whole multiples of their side, clipped to the area.
std::vector<NamedStand> grid_cells(const NamedStand& whole, double grid, double unit) {
  const Eigen::AlignedBox2d box = pipeline::bounds(whole.polygon);
  const Eigen::Array2d cells_across = box.sizes().array() / grid + 1;
  if (!(cells_across.prod() < 1e6))
    throw Error(ErrorCode::usage,
                fmt::format("the grid would have {:.6g} x {:.6g} cells", cells_across.x(), cells_across.y()),
                "", "widen the cells: --grid METRES");
  const auto first = [&](double low) { return static_cast<std::int64_t>(std::floor(low / grid)); };
  const std::int64_t columns = first(box.max().x()) - first(box.min().x()) + 1,
                     rows = first(box.max().y()) - first(box.min().y()) + 1;
  if (columns * rows > 100'000)
    throw Error(ErrorCode::usage, fmt::format("the grid would have {} x {} cells", columns, rows), "",
                "widen the cells: --grid METRES");
  std::vector<NamedStand> cells;
  for (std::int64_t j = rows - 1; j >= 0; --j)
    for (std::int64_t i = 0; i < columns; ++i) {
      const double x = static_cast<double>(first(box.min().x()) + i) * grid,
                   y = static_cast<double>(first(box.min().y()) + j) * grid;
      const pipeline::StandPolygon part =
          pipeline::clip_polygon(whole.polygon, {Eigen::Vector2d(x, y), Eigen::Vector2d(x + grid, y + grid)});
      if (!(pipeline::area(part) > 1)) continue;
      NamedStand cell{
          .name = fmt::format("{:.0f}_{:.0f}", x, y), .species = {}, .polygon = part, .outline = {}};
      for (const auto& ring : part.rings) {
        std::vector<Eigen::Vector2d> corners;
        for (const auto& corner : ring) corners.push_back(corner / unit);
        if (cell.outline.empty())
          cell.outline.push_back({.outer = std::move(corners)});
        else
          cell.outline[0].holes.push_back(std::move(corners));
      }
      cells.push_back(std::move(cell));
    }
  return cells;
}

/// Reads the polygons of a layer.
StandAreas read_outlines(const StandSource& source, const geodb::MapStore& map, double unit) {
  importers::StandOutlines read = importers::read_stand_outlines(source.file, source.layer, map.crs());
  StandAreas areas{.stands = {}, .warnings = std::move(read.warnings), .failed = std::move(read.failed)};
  for (importers::StandOutline& outline : read.stands) {
    NamedStand stand{.name = outline.name, .species = outline.species, .polygon = {}, .outline = {}};
    for (auto& rings : outline.polygons) {
      geodb::ShapePart part{.outer = rings[0]};
      part.holes.assign(rings.begin() + 1, rings.end());
      stand.outline.push_back(std::move(part));
    }
    stand.polygon = in_metres(stand.outline, unit);
    areas.stands.push_back(std::move(stand));
  }
  return areas;
}

}  // namespace

StandAreas read_stand_areas(const StandSource& source, const geodb::MapStore& map, const TreeReader& trees) {
  if (!source.file.empty()) return read_outlines(source, map, trees.unit());
  StandAreas areas;
  const NamedStand whole = whole_map(map, trees, areas.warnings);
  if (source.grid == 0)
    areas.stands = {whole};
  else
    areas.stands = grid_cells(whole, source.grid, trees.unit());
  return areas;
}

}  // namespace waymark::workflows
