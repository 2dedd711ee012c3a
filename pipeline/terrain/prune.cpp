// SPDX-License-Identifier: Apache-2.0
// Saddles of a tile are processed from the highest down, as if the water level sank; each saddle joins two
// islands.
// The lower island is contracted into the higher one if its summit has not reached the required prominence
// and it contains nothing that another tile needs above the saddle: a portal, a kept summit, a cell on the
// tile's border or next to unknown terrain.
// Every path that other tiles can use keeps its height: it enters a contracted island only below the saddle
// that joined it.
#include <algorithm>

#include "pipeline/terrain/cell_order.hpp"
#include "pipeline/terrain/disjoint_sets.hpp"
#include "pipeline/terrain/divide_tree.hpp"

namespace waymark::pipeline {
namespace {

struct Island {
  std::int32_t summit = -1;    // highest summit known in this tile; -1: portals only
  bool holds_others = false;   // a portal or a kept summit besides `summit`
  double exposed = kNoHeight;  // highest cell on the tile's border or next to unknown terrain
};

std::vector<Island> initial_islands(const DivideTree& tree) {
  std::vector<Island> islands;
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const auto& node = tree.nodes[i];
    islands.push_back({node.portal ? -1 : static_cast<std::int32_t>(i), node.portal, node.contact});
  }
  for (const auto& border : tree.border) {
    double& exposed = islands[static_cast<std::size_t>(border.node)].exposed;
    exposed = std::max(exposed, border.height);
  }
  return islands;
}

// Renumbers the kept nodes and reconnects saddles and border cells of contracted ones.
DivideTree remove_contracted(const DivideTree& tree, const std::vector<DivideTree::Saddle>& saddles,
                             std::vector<std::int32_t> contracted_into) {
  std::vector<std::int32_t> number(tree.nodes.size(), -1);
  DivideTree kept;
  kept.window = tree.window;
  kept.cells = tree.cells;
  kept.maxima = tree.maxima;
  kept.min_prominence = tree.min_prominence;
  kept.lowest = tree.lowest;
  kept.highest = tree.highest;
  kept.voids = tree.voids;
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    if (contracted_into[i] >= 0) continue;
    number[i] = static_cast<std::int32_t>(kept.nodes.size());
    kept.nodes.push_back(tree.nodes[i]);
  }
  const auto new_number = [&](std::int32_t node) {
    auto at = static_cast<std::size_t>(node);
    while (contracted_into[at] >= 0) {
      const auto next = static_cast<std::size_t>(contracted_into[at]);
      if (contracted_into[next] >= 0) contracted_into[at] = contracted_into[next];
      at = next;
    }
    return number[at];
  };
  for (const auto& saddle : saddles)
    kept.saddles.push_back({saddle.cell, saddle.height, new_number(saddle.a), new_number(saddle.b)});
  for (std::size_t i = 0; i < tree.nodes.size(); ++i)
    if (contracted_into[i] >= 0) {
      auto& into = kept.nodes[static_cast<std::size_t>(new_number(static_cast<std::int32_t>(i)))];
      into.contact = std::max(into.contact, tree.nodes[i].contact);
    }
  for (const auto& border : tree.border)
    kept.border.push_back({border.cell, border.height, new_number(border.node)});
  return kept;
}

}  // namespace

DivideTree prune(DivideTree tree, double min_prominence) {
  const auto height = [&](std::int32_t node) { return tree.nodes[static_cast<std::size_t>(node)].height; };
  const auto cell = [&](std::int32_t node) { return tree.nodes[static_cast<std::size_t>(node)].cell; };
  std::vector<Island> islands = initial_islands(tree);
  std::vector<std::int32_t> contracted_into(tree.nodes.size(), -1);
  std::vector<DivideTree::Saddle> saddles;
  DisjointSets sets(tree.nodes.size());

  for (const auto& saddle : tree.saddles) {
    std::size_t low = sets.root(static_cast<std::size_t>(saddle.a));
    std::size_t high = sets.root(static_cast<std::size_t>(saddle.b));
    if (low == high) continue;
    const std::int32_t a = islands[low].summit, b = islands[high].summit;
    if (b < 0 || (a >= 0 && is_higher(height(a), cell(a), height(b), cell(b)))) std::swap(low, high);

    Island& sunk = islands[low];
    Island& into = islands[high];
    const bool both_known = sunk.summit >= 0 && into.summit >= 0;
    if (both_known && !sunk.holds_others && sunk.exposed < saddle.height &&
        height(sunk.summit) - saddle.height < min_prominence) {
      contracted_into[static_cast<std::size_t>(sunk.summit)] = into.summit;
    } else {
      saddles.push_back(saddle);
      into.holds_others = true;
    }
    into.exposed = std::max(into.exposed, sunk.exposed);
    sets.join(low, high);
  }
  return remove_contracted(tree, saddles, std::move(contracted_into));
}

}  // namespace waymark::pipeline
