// SPDX-License-Identifier: Apache-2.0
#include "pipeline/terrain/prominence.hpp"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "pipeline/terrain/cell_order.hpp"
#include "pipeline/terrain/disjoint_sets.hpp"

namespace waymark::pipeline {
namespace {

using Tiles = std::span<const std::shared_ptr<const DivideTree>>;

struct Peak {
  std::int64_t cell;
  double height;
  double contact;
};

struct Link {
  std::int64_t cell;  // the saddle
  double height;
  std::size_t a, b;  // peaks
};

// Hash map from border cells to nodes: open addressing, at most half full. Building a std::unordered_map
// would take longer than the rest of the join.
class BorderNodes {
 public:
  explicit BorderNodes(std::size_t count) : slots_(std::bit_ceil(2 * count + 1)) {}

  void add(std::int64_t cell, std::size_t node) { slots_[find_slot(cell)] = {cell, node}; }
  std::size_t node(std::int64_t cell) const {
    const Slot& slot = slots_[find_slot(cell)];
    if (slot.cell != cell) throw std::logic_error("a tile of the divide tree is missing");
    return slot.node;
  }

 private:
  struct Slot {
    std::int64_t cell = -1;  // -1: free
    std::size_t node = 0;
  };

  // Returns the slot of the cell or a free slot. Neighbouring cells are spread by the golden ratio (Knuth,
  // vol. 3, 6.4).
  std::size_t find_slot(std::int64_t cell) const {
    const std::size_t last = slots_.size() - 1;
    const std::uint64_t spread = static_cast<std::uint64_t>(cell) * 0x9E3779B97F4A7C15u;
    std::size_t at = static_cast<std::size_t>(spread >> 32) & last;
    while (slots_[at].cell != cell && slots_[at].cell >= 0) at = (at + 1) & last;
    return at;
  }

  std::vector<Slot> slots_;
};

std::size_t border_count(Tiles tiles) {
  std::size_t count = 0;
  for (const auto& tile : tiles) count += tile->border.size();
  return count;
}

// Summits of all tiles and the saddles between them, with every portal replaced by its summit.
class WholeGrid {
 public:
  explicit WholeGrid(Tiles tiles) : border_(border_count(tiles)) {
    std::size_t first = 0;
    for (const auto& tile : tiles) {
      for (const auto& border : tile->border)
        border_.add(border.cell, first + static_cast<std::size_t>(border.node));
      first += tile->nodes.size();
      nodes_.insert(nodes_.end(), tile->nodes.begin(), tile->nodes.end());
    }
    summit_.assign(nodes_.size(), kOpen);
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      if (!nodes_[i].portal) {
        summit_[i] = peaks.size();
        peaks.push_back({nodes_[i].cell, nodes_[i].height, nodes_[i].contact});
      }
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      Peak& peak = peaks[summit_of(i)];
      peak.contact = std::max(peak.contact, nodes_[i].contact);
    }
    first = 0;
    for (const auto& tile : tiles) {
      for (const auto& saddle : tile->saddles)
        links.push_back({saddle.cell, saddle.height, summit_of(first + static_cast<std::size_t>(saddle.a)),
                         summit_of(first + static_cast<std::size_t>(saddle.b))});
      first += tile->nodes.size();
    }
    tbb::parallel_sort(links.begin(), links.end(), [](const Link& p, const Link& q) {
      return is_higher(p.height, p.cell, q.height, q.cell);
    });
  }

  std::vector<Peak> peaks;
  std::vector<Link> links;  // highest first

 private:
  static constexpr std::size_t kOpen = static_cast<std::size_t>(-1);

  std::size_t summit_of(std::size_t node) {
    std::vector<std::size_t>& path = path_;
    path.clear();
    while (summit_[node] == kOpen) {
      path.push_back(node);
      node = border_.node(nodes_[node].cell);
    }
    for (const std::size_t passed : path) summit_[passed] = summit_[node];
    return summit_[node];
  }

  std::vector<DivideTree::Node> nodes_;
  BorderNodes border_;
  std::vector<std::size_t> summit_;  // of each node, as an index of peaks
  std::vector<std::size_t> path_;
};

// Merges islands from the highest saddle down. All links of one saddle cell act together: the highest island
// survives and is the parent of the others.
class SaddleSweep {
 public:
  explicit SaddleSweep(WholeGrid& grid) : grid_(grid), islands_(grid.peaks.size()), ends_(grid.peaks.size()) {
    auto& links = grid.links;
    for (std::size_t first = 0, last; first < links.size(); first = last) {
      for (last = first; last < links.size() && links[last].cell == links[first].cell;) ++last;
      meet(std::span(links).subspan(first, last - first));
    }
  }

  struct End {
    const Link* saddle = nullptr;  // nullptr: no higher ground
    std::size_t parent = 0;
    double contact = kNoHeight;  // of the island when it was merged
  };
  const End& end(std::size_t peak) {
    if (!ends_[peak].saddle) ends_[peak].contact = grid_.peaks[peak].contact;
    return ends_[peak];
  }

 private:
  void meet(std::span<const Link> links) {
    for (const Link& link : links) {
      std::size_t low = islands_.root(link.a), high = islands_.root(link.b);
      if (low == high) continue;
      if (is_higher(grid_.peaks[low].height, grid_.peaks[low].cell, grid_.peaks[high].height,
                    grid_.peaks[high].cell))
        std::swap(low, high);
      ends_[low] = {&link, high, grid_.peaks[low].contact};
      sunk_.push_back(low);
      islands_.join(low, high);
    }
    // The contact of an island counts for its survivor only below this saddle.
    for (const std::size_t low : sunk_) {
      const std::size_t survivor = islands_.root(low);
      ends_[low].parent = survivor;
      grid_.peaks[survivor].contact = std::max(grid_.peaks[survivor].contact, ends_[low].contact);
    }
    sunk_.clear();
  }

  WholeGrid& grid_;
  DisjointSets islands_;
  std::vector<End> ends_;
  std::vector<std::size_t> sunk_;  // at the current saddle
};

double base_height(Tiles tiles, BasePolicy base) {
  double lowest = 0, highest = 0;
  bool any = false;
  for (const auto& tile : tiles) {
    if (tile->cells == 0) continue;
    lowest = any ? std::min(lowest, tile->lowest) : tile->lowest;
    highest = any ? std::max(highest, tile->highest) : tile->highest;
    any = true;
  }
  switch (base) {
    case BasePolicy::sea:
      return 0;
    case BasePolicy::lowest:
      return lowest;
    case BasePolicy::none:
      return Summit::kUnknown;
    case BasePolicy::automatic:
      break;
  }
  return highest > 0 ? 0 : lowest;
}

}  // namespace

std::vector<Summit> join_divide_trees(Tiles tiles, double min_prominence, BasePolicy base) {
  WholeGrid grid(tiles);
  SaddleSweep sweep(grid);
  const double ground = base_height(tiles, base);

  std::vector<Summit> summits;
  for (std::size_t i = 0; i < grid.peaks.size(); ++i) {
    const Peak& peak = grid.peaks[i];
    const SaddleSweep::End& end = sweep.end(i);
    Summit summit{.cell = peak.cell, .height = peak.height};
    const double floor = end.saddle ? end.saddle->height : ground;
    summit.prominence = peak.height - floor;
    if (summit.prominence <= 0 || summit.prominence < min_prominence) continue;
    summit.prominence_low = std::isnan(floor) && end.contact == kNoHeight
                                ? Summit::kUnknown
                                : peak.height - std::fmax(floor, end.contact);
    if (end.saddle) {
      summit.saddle = end.saddle->cell;
      summit.saddle_height = end.saddle->height;
      summit.parent = grid.peaks[end.parent].cell;
    }
    summits.push_back(summit);
  }
  std::ranges::sort(summits, [](const Summit& p, const Summit& q) {
    return is_higher(p.height, p.cell, q.height, q.cell);
  });
  return summits;
}

}  // namespace waymark::pipeline
