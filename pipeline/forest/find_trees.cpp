// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/find_trees.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/forest/tree_confidence.hpp"

namespace waymark::pipeline {
namespace {

Window grow_window(const Window& window, std::int64_t by) {
  return {window.column - by, window.row - by, window.columns + 2 * by, window.rows + 2 * by};
}

std::int64_t tops_reach(const TreeSearch& search, double cell) {
  std::int64_t reach = treetop_reach(search.forest.tops, cell);
  for (const TreetopRules& rules : search.by_type) reach = std::max(reach, treetop_reach(rules, cell));
  return reach;
}

CanopyWindow window_of(const CanopySource& canopy, const Window& cells) {
  const Georeference& where = canopy.geometry().where;
  const double metres = where.crs.metres_per_unit();
  return {cells, canopy.read(cells), where.dx * metres, -where.dy * metres};
}

RulesAt rules_at(const TreeSearch& search, const Window& cells, const Grid<std::uint8_t>& types) {
  if (types.columns() == 0 || search.by_type.empty())
    return [&search](const CanopyCell&) -> const TreetopRules& { return search.forest.tops; };
  return [&search, &types, cells](const CanopyCell& c) -> const TreetopRules& {
    const std::uint8_t type = types(c.column - cells.column, c.row - cells.row);
    return type == 0 ? search.forest.tops : search.by_type.at(type - 1U);
  };
}

// Distance in cells beyond `owned` within which tops are needed, for crowns and rivals.
std::int64_t needed_beyond(const TreeSearch& search, double cell) {
  const auto rivals = static_cast<std::int64_t>(std::ceil(kRivalReach / cell)) + 1;
  return search.crowns ? std::max(rivals, crown_reach(search.forest.crowns, cell)) : rivals;
}

ForestType type_at(const Grid<std::uint8_t>& types, const Window& cells, const CanopyCell& at,
                   ForestType otherwise) {
  const std::uint8_t type = types.columns() ? types(at.column - cells.column, at.row - cells.row) : 0;
  return type == 0 ? otherwise : static_cast<ForestType>(type);
}

ForestType type_of(const ForestPreset& preset) {
  for (const ForestType type : {ForestType::conifer, ForestType::broadleaf})
    if (preset.name == forest_preset(type).name) return type;
  return ForestType::mixed;
}

// Smoothing lowers a top, so its height is the maximum of the raw cells around it.
double height_at(const CanopyWindow& raw, const CanopyCell& top) {
  float highest = 0;
  for (std::int64_t r = -1; r <= 1; ++r)
    for (std::int64_t c = -1; c <= 1; ++c)
      if (const CanopyCell cell{top.column + c, top.row + r}; raw.contains(cell))
        highest = std::max(highest, raw.at(cell));
  return static_cast<double>(highest);
}

}  // namespace

std::int64_t search_halo(const TreeSearch& search, double cell) {
  const std::int64_t tops = tops_reach(search, cell),
                     smoothing = smoothing_reach(search.forest.smoothing, cell);
  const std::int64_t beyond = needed_beyond(search, cell);
  if (!search.crowns) return beyond + tops + smoothing + 1;
  const std::int64_t crown = crown_reach(search.forest.crowns, cell);
  return std::max(5 * crown / 2 + 3, beyond + tops) + smoothing + 1;
}

std::vector<DetectedTree> find_trees(const CanopySource& canopy, const Window& owned,
                                     const TreeSearch& search) {
  const Georeference& where = canopy.geometry().where;
  const double unit = where.crs.metres_per_unit();
  const double width = where.dx * unit, height = -where.dy * unit, min_side = std::min(width, height);
  if (owned.columns <= 0 || owned.rows <= 0) return {};
  const CanopyWindow raw = window_of(canopy, grow_window(owned, search_halo(search, min_side)));
  const CanopyWindow smooth = smooth_canopy(raw, search.forest.smoothing);
  const Grid<std::uint8_t> types =
      search.by_type.empty() ? Grid<std::uint8_t>{} : canopy.forest_types(raw.cells);
  const RulesAt rules = rules_at(search, raw.cells, types);
  const std::int64_t beyond = needed_beyond(search, min_side);
  const std::vector<Treetop> tops = find_treetops(smooth, grow_window(owned, beyond), rules);
  std::vector<Crown> crowns;
  if (search.crowns) crowns = find_crowns(smooth, owned, tops, search.forest.crowns);
  std::vector<DetectedTree> trees;
  for (std::size_t i = 0; i < tops.size(); ++i) {
    const Treetop& top = tops[i];
    if (!owned.contains(top.cell.column, top.cell.row)) continue;
    DetectedTree tree{.top = top.cell, .height = height_at(raw, top.cell), .crown = {}};
    if (search.crowns) tree.crown = std::move(crowns[trees.size()]);
    tree.crown_area = static_cast<double>(tree.crown.cells) * width * height;
    tree.crown_diameter = 2 * std::sqrt(tree.crown_area / std::numbers::pi);
    tree.confidence = tree_confidence(top_evidence(raw, smooth, tops, i),
                                      type_at(types, raw.cells, top.cell, type_of(search.forest)));
    trees.push_back(std::move(tree));
  }
  return trees;
}

}  // namespace waymark::pipeline
