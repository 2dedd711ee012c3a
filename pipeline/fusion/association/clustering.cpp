// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/association/clustering.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <tuple>

namespace waymark::pipeline {
namespace {

using Index = std::uint32_t;

Index root(std::vector<Index>& parent, Index i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

bool have_common_source(const std::vector<Index>& a, const std::vector<Index>& b) {  // both ascending
  for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();) {
    if (*i == *j) return true;
    *i < *j ? ++i : ++j;
  }
  return false;
}

struct Cluster {
  ObservedObject fused;
  std::vector<Index> sources;     // ascending
  std::vector<Index> neighbours;  // neighbours at the start; some may have been merged since
  Index version = 0;              // number of merges
};

struct Candidate {
  double cost = 0;
  Index a = 0, b = 0;  // a < b
  Index a_version = 0, b_version = 0;
  // The top of the queue is its largest element.
  friend bool operator<(const Candidate& l, const Candidate& r) {
    return std::tie(r.cost, r.a, r.b) < std::tie(l.cost, l.a, l.b);
  }
};

// Connected component of objects under possible pairs. Clusters are numbered by their first member, in the
// order of objects.
class Group {
 public:
  Group(std::span<const ObservedObject> objects, std::span<const Index> members,
        std::span<const IndexPair> pairs, const MapPlane& plane, const AssociationRules& rules)
      : plane_(plane), rules_(rules), clusters_(members.size()), parent_(members.size()) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
    for (std::size_t i = 0; i < members.size(); ++i) {
      clusters_[i].fused = objects[members[i]];
      clusters_[i].sources = {objects[members[i]].source};
    }
    const auto local = [&](Index member) {
      return static_cast<Index>(std::lower_bound(members.begin(), members.end(), member) - members.begin());
    };
    for (const IndexPair& pair : pairs) {
      const Index a = local(pair.first), b = local(pair.second);
      clusters_[a].neighbours.push_back(b), clusters_[b].neighbours.push_back(a);
      consider(a, b);
    }
  }

  /// Returns per member the number of its cluster.
  std::vector<Index> solve() {
    while (!queue_.empty()) {
      const Candidate best = queue_.top();
      queue_.pop();
      const bool stands = clusters_[best.a].version == best.a_version &&
                          clusters_[best.b].version == best.b_version && parent_[best.a] == best.a &&
                          parent_[best.b] == best.b;
      if (stands) absorb(best.a, best.b);
    }
    std::vector<Index> thing(clusters_.size());
    for (Index i = 0; i < thing.size(); ++i) thing[i] = root(parent_, i);
    return thing;
  }

 private:
  void consider(Index a, Index b) {
    if (a > b) std::swap(a, b);
    const Cluster &first = clusters_[a], &second = clusters_[b];
    if (have_common_source(first.sources, second.sources)) return;
    if (const auto cost = association_cost(first.fused, second.fused, plane_, rules_))
      queue_.push({*cost, a, b, first.version, second.version});
  }

  void absorb(Index a, Index b) {
    Cluster &kept = clusters_[a], &gone = clusters_[b];
    parent_[b] = a;
    kept.fused = fuse(kept.fused, gone.fused, plane_);
    ++kept.version;
    std::vector<Index> sources;
    std::merge(kept.sources.begin(), kept.sources.end(), gone.sources.begin(), gone.sources.end(),
               std::back_inserter(sources));
    kept.sources = std::move(sources);
    std::vector<Index> around;
    for (const auto* list : {&kept.neighbours, &gone.neighbours})
      for (const Index n : *list)
        if (const Index now = root(parent_, n); now != a) around.push_back(now);
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    std::erase_if(around, [&](Index n) { return have_common_source(kept.sources, clusters_[n].sources); });
    gone = {};
    kept.neighbours = std::move(around);
    for (const Index n : kept.neighbours) consider(a, n);
  }

  const MapPlane& plane_;
  const AssociationRules& rules_;
  std::vector<Cluster> clusters_;
  std::vector<Index> parent_;
  std::priority_queue<Candidate> queue_;
};

// Items grouped by key in stable order: starts[k] .. starts[k + 1] of `items`.
struct Buckets {
  std::vector<Index> starts, items;

  Buckets(std::size_t keys, std::size_t count, const auto& key_of) : starts(keys + 1, 0), items(count) {
    for (std::size_t i = 0; i < count; ++i) ++starts[key_of(i) + 1];
    for (std::size_t k = 0; k < keys; ++k) starts[k + 1] += starts[k];
    std::vector<Index> next(starts.begin(), starts.end() - 1);
    for (std::size_t i = 0; i < count; ++i) items[next[key_of(i)]++] = static_cast<Index>(i);
  }
  std::span<const Index> of(std::size_t key) const {
    return std::span(items).subspan(starts[key], starts[key + 1] - starts[key]);
  }
};

double candidate_reach(const ObservedObject& object, const MapPlane& plane, const AssociationRules& rules) {
  return gate_radius(object, rules) * (plane.flat() ? 1 : 1.0002);
}

double duplicate_reach(const ObservedObject& object, const AssociationRules& rules) {
  return std::isnan(object.log_size) ? 0 : rules.duplicate_overlap * std::exp(object.log_size);
}

}  // namespace

std::vector<IndexPair> candidate_pairs(std::span<const ObservedObject> objects, const MapPlane& plane,
                                       const AssociationRules& rules) {
  std::vector<Eigen::Vector3d> points(objects.size());
  std::vector<double> reaches(objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) {
    points[i] = plane.to_cartesian(objects[i].at);
    reaches[i] = candidate_reach(objects[i], plane, rules);
  }
  return find_neighbour_pairs(points, reaches, [&](Index a, Index b) {
    const ObservedObject &s = objects[a], &t = objects[b];
    return s.type == t.type && s.source != t.source && association_cost(s, t, plane, rules);
  });
}

std::vector<IndexPair> duplicate_pairs(std::span<const ObservedObject> objects, const MapPlane& plane,
                                       const AssociationRules& rules) {
  std::vector<Eigen::Vector3d> points(objects.size());
  std::vector<double> reaches(objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) {
    points[i] = plane.to_cartesian(objects[i].at);
    reaches[i] = duplicate_reach(objects[i], rules);
  }
  return find_neighbour_pairs(points, reaches, [&](Index a, Index b) {
    const ObservedObject &s = objects[a], &t = objects[b];
    return s.type == t.type && s.source == t.source && are_duplicates(s, t, plane, rules);
  });
}

double pair_reach(const ObservedObject& object, const MapPlane& plane, const AssociationRules& rules) {
  return std::max(candidate_reach(object, plane, rules), duplicate_reach(object, rules));
}

std::vector<std::uint32_t> cluster(std::span<const ObservedObject> objects, const MapPlane& plane,
                                   const AssociationRules& rules) {
  const bool one_source = std::ranges::all_of(
      objects, [&](const ObservedObject& s) { return s.source == objects.front().source; });
  const std::vector<IndexPair> pairs =
      one_source ? std::vector<IndexPair>() : candidate_pairs(objects, plane, rules);
  std::vector<Index> group(objects.size());
  std::iota(group.begin(), group.end(), Index{0});
  for (const IndexPair& pair : pairs) {
    const Index a = root(group, pair.first), b = root(group, pair.second);
    group[std::max(a, b)] = std::min(a, b);
  }
  for (Index i = 0; i < group.size(); ++i) group[i] = root(group, i);

  const Buckets members(group.size(), group.size(), [&](std::size_t i) { return group[i]; });
  const Buckets links(group.size(), pairs.size(), [&](std::size_t i) { return group[pairs[i].first]; });
  std::vector<Index> thing = group;
  tbb::parallel_for(std::size_t{0}, group.size(), [&](std::size_t g) {
    const auto in_group = members.of(g);
    if (in_group.size() < 2) return;
    std::vector<IndexPair> own;
    for (const Index i : links.of(g)) own.push_back(pairs[i]);
    const auto solved = Group(objects, in_group, own, plane, rules).solve();
    for (std::size_t i = 0; i < in_group.size(); ++i) thing[in_group[i]] = in_group[solved[i]];
  });
  return thing;
}

}  // namespace waymark::pipeline
