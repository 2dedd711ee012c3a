// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/crown_names.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "landmarks/uid_index.hpp"

namespace waymark::pipeline {

CrownTable name_crowns(std::span<const CrownTable> drawn, std::span<const Observation> evidence,
                       std::span<const Landmark> trees) {
  struct Place {
    double x = 0, y = 0;
    std::uint32_t part = 0, row = 0;
  };
  std::map<std::string_view, std::vector<Place>> of_source;
  for (std::uint32_t part = 0; part < drawn.size(); ++part)
    for (std::uint32_t row = 0; row < drawn[part].size(); ++row) {
      const Eigen::Vector2d top = drawn[part].top(row);
      of_source[drawn[part].source(row)].push_back({top.x(), top.y(), part, row});
    }
  const auto by_place = [](const Place& place) { return std::pair(place.x, place.y); };
  for (auto& [_, places] : of_source) std::ranges::sort(places, {}, by_place);
  const UidIndex index(trees);
  std::vector<const Place*> of_tree(trees.size());
  for (const Observation& o : evidence) {  // sorted by source, then position: the first survey by name wins
    if (!o.rejected.empty() || o.landmark_uid.empty()) continue;
    const auto tree = index.find(o.landmark_uid);
    const auto places = of_source.find(o.source);
    if (!tree || of_tree[*tree] || places == of_source.end()) continue;
    const std::pair at(o.position.xyz.x(), o.position.xyz.y());
    const auto place = std::ranges::lower_bound(places->second, at, {}, by_place);
    if (place != places->second.end() && by_place(*place) == at) of_tree[*tree] = &*place;
  }
  CrownTable crowns;
  for (std::size_t i = 0; i < trees.size(); ++i)
    if (const Place* place = of_tree[i]; place && drawn[place->part].has_outline(place->row))
      crowns.add(drawn[place->part], place->row, trees[i].uid);
  crowns.shrink_to_fit();
  return crowns;
}

}  // namespace waymark::pipeline
