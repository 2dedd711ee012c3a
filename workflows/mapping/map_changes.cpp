// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/map_changes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "geo/convex_hull.hpp"
#include "pipeline/fusion/association/map_plane.hpp"
#include "pipeline/fusion/association/merging.hpp"
#include "pipeline/fusion/projection/footprint.hpp"
#include "pipeline/fusion/valuation/landmark_fusion.hpp"

namespace waymark::workflows {
namespace {

using Outline = std::vector<Eigen::Vector2d>;
constexpr double kAsSharp = 1.1;  // as eq. 4's test of resolutions (docs/methods/qualities.md)

/// What a map shows, in metres about a position.
class Coverage {
 public:
  Coverage(const LoadedMap& map, const pipeline::MapPlane& plane, const Eigen::Vector2d& about)
      : plane_(&plane), about_(about) {
    for (const geodb::ImageRecord& image : map.images) {
      if (image.gsd) gsd_.emplace(image.name, image.gsd->value);
      for (const auto& ring : image.footprint) {
        View& view = views_.emplace_back();
        view.gsd = image.gsd ? image.gsd->value : 0;
        for (const Eigen::Vector2d& vertex : ring) view.add(metres(vertex));
      }
    }
    if (!views_.empty()) return;
    Outline points;
    for (const Landmark& landmark : map.landmarks) points.push_back(metres(landmark.position.xyz.head<2>()));
    View& hull = views_.emplace_back();
    for (const Eigen::Vector2d& vertex : convex_hull(std::move(points))) hull.add(vertex);
  }

  /// Returns whether something at least as sharp shows the position, CRS units.
  bool covers(const Eigen::Vector2d& position, double coarsest_gsd) const {
    const Eigen::Vector2d at = metres(position);
    return std::ranges::any_of(views_, [&](const View& view) {
      return view.gsd <= kAsSharp * coarsest_gsd && view.box.contains(at) && pipeline::inside(view.ring, at);
    });
  }

  /// Returns the ground sample distance of the coarsest image among the sources; infinity if none is known.
  double coarsest(const std::vector<const Observation*>& seen) const {
    double gsd = 0;
    for (const Observation* one : seen)
      if (const auto image = gsd_.find(one->source); image != gsd_.end()) gsd = std::max(gsd, image->second);
    return gsd > 0 ? gsd : std::numeric_limits<double>::infinity();
  }

 private:
  struct View {
    Outline ring;
    Eigen::AlignedBox2d box;
    double gsd = 0;
    void add(const Eigen::Vector2d& vertex) {
      ring.push_back(vertex);
      box.extend(vertex);
    }
  };
  Eigen::Vector2d metres(const Eigen::Vector2d& position) const { return plane_->offset(about_, position); }

  const pipeline::MapPlane* plane_;
  Eigen::Vector2d about_;
  std::vector<View> views_;
  std::unordered_map<std::string, double> gsd_;
};

/// Landmark that one map alone has, and whether the other map covers it.
struct Single {
  std::size_t index = 0;
  bool covered = false;
};

std::vector<Single> only_in(const LoadedMap& map, const Coverage& own, const Coverage& other,
                            const std::vector<bool>& has_partner) {
  std::unordered_map<std::string, std::vector<const Observation*>> seen;
  for (const Observation& one : map.evidence)
    if (one.rejected.empty()) seen[one.landmark_uid].push_back(&one);
  std::vector<Single> alone;
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) {
    if (has_partner[i]) continue;
    const Landmark& landmark = map.landmarks[i];
    alone.push_back({i, other.covers(landmark.position.xyz.head<2>(), own.coarsest(seen[landmark.uid]))});
  }
  return alone;
}

double distance_of(const Landmark& a, const Landmark& b, const pipeline::MapPlane& plane) {
  return plane.offset(a.position.xyz.head<2>(), b.position.xyz.head<2>()).norm();
}

/// Pairs landmarks of the earlier map alone with those of the later map alone: per index in `before`, that in
/// `after`. One of both at least is covered by the other map.
std::vector<std::optional<std::size_t>> find_moves(const LoadedMap& earlier,
                                                   const std::vector<Single>& before, const LoadedMap& later,
                                                   const std::vector<Single>& after, double max_move) {
  std::vector<std::optional<std::size_t>> moves(before.size());
  if (!(max_move > 0)) return moves;
  std::vector<Observation> seen;
  for (const Single& one : before)
    seen.push_back(pipeline::as_observation(earlier.landmarks[one.index], "earlier"));
  for (const Single& one : after)
    seen.push_back(pipeline::as_observation(later.landmarks[one.index], "later"));
  pipeline::AssociationRules rules;
  rules.position_floor = rules.max_distance = max_move;
  const std::vector<std::uint32_t> first = pipeline::associate(seen, earlier.types, earlier.crs, rules);
  for (std::size_t s = before.size(); s < seen.size(); ++s) {
    const std::size_t from = first[s], to = s - before.size();
    if (from < before.size() && (before[from].covered || after[to].covered)) moves[from] = to;
  }
  return moves;
}

const char* word_of(ChangeKind kind) {
  switch (kind) {
    case ChangeKind::gone:
      return "gone";
    case ChangeKind::appeared:
      return "new";
    case ChangeKind::moved:
      return "moved";
  }
  return "";
}

}  // namespace

bool same_place(const Landmark& a, const Landmark& b, const TypeRegistry& types, const Crs& crs) {
  const Observation both[] = {pipeline::as_observation(a, "a"), pipeline::as_observation(b, "b")};
  return pipeline::associate(both, types, crs)[1] == 0;
}

MapChanges find_changes(const LoadedMap& earlier, const LoadedMap& later,
                        const std::vector<std::optional<std::size_t>>& partners, double max_move) {
  MapChanges found;
  if (earlier.landmarks.empty() && later.landmarks.empty()) return found;
  const pipeline::MapPlane plane(earlier.crs);
  const LoadedMap& some = earlier.landmarks.empty() ? later : earlier;
  const Eigen::Vector2d about = some.landmarks[0].position.xyz.head<2>();
  const Coverage of_earlier(earlier, plane, about), of_later(later, plane, about);
  std::vector<bool> kept(earlier.landmarks.size()), known(later.landmarks.size());
  for (std::size_t j = 0; j < later.landmarks.size(); ++j) {
    if (!partners[j]) continue;
    known[j] = kept[*partners[j]] = true;
    const Landmark &was = earlier.landmarks[*partners[j]], &is = later.landmarks[j];
    if (same_place(was, is, earlier.types, earlier.crs))
      ++found.unchanged;
    else
      found.changes.push_back({ChangeKind::moved, *partners[j], j, distance_of(was, is, plane)});
  }
  const std::vector<Single> before = only_in(earlier, of_earlier, of_later, kept),
                            after = only_in(later, of_later, of_earlier, known);
  const auto moves = find_moves(earlier, before, later, after, max_move);
  std::vector<bool> moved(after.size());
  for (std::size_t k = 0; k < before.size(); ++k) {
    const std::size_t was = before[k].index;
    if (moves[k]) {
      moved[*moves[k]] = true;
      const std::size_t is = after[*moves[k]].index;
      found.changes.push_back(
          {ChangeKind::moved, was, is, distance_of(earlier.landmarks[was], later.landmarks[is], plane)});
    } else if (before[k].covered) {
      found.changes.push_back({ChangeKind::gone, was, {}, 0});
    } else {
      ++found.not_covered;
    }
  }
  std::ranges::sort(found.changes, {}, [](const MapChange& change) { return *change.earlier; });
  for (std::size_t k = 0; k < after.size(); ++k) {
    if (moved[k]) continue;
    if (after[k].covered)
      found.changes.push_back({ChangeKind::appeared, {}, after[k].index, 0});
    else
      ++found.not_covered;
  }
  return found;
}

geodb::ShapeLayer change_layer(const MapChanges& changes, const LoadedMap& earlier, const LoadedMap& later,
                               const std::function<std::string(const MapChange&)>& uid_of) {
  using Kind = AttributeSpec::Kind;
  geodb::ShapeLayer layer{
      .name = "change",
      .summary = "Changes from the earlier map to the later one",
      .kind = geodb::ShapeKind::point,
      .columns = {{"change", "", Kind::text, "gone, new or moved"},
                  {"type", "", Kind::text, "Landmark type"},
                  {"uid", "", Kind::text, "Landmark of this map; of a move where it is now"},
                  {"earlier_uid", "", Kind::text, "Landmark of the earlier map"},
                  {"later_uid", "", Kind::text, "Landmark of the later map"},
                  {"distance", "m", Kind::real, "Distance of a move"},
                  {"confidence", "", Kind::real,
                   "Probability that the landmark existed, of a move the smaller"}},
      .style = {.colour = "#d62728", .label = "change"}};
  for (const MapChange& change : changes.changes) {
    const Landmark* was = change.earlier ? &earlier.landmarks[*change.earlier] : nullptr;
    const Landmark* is = change.later ? &later.landmarks[*change.later] : nullptr;
    const Landmark& shown = is ? *is : *was;
    double confidence = shown.confidence;
    if (was && is) confidence = std::min(was->confidence, is->confidence);
    const auto uid = [](const Landmark* landmark) {
      return landmark ? AttributeValue(landmark->uid) : AttributeValue();
    };
    layer.rows.push_back(
        {.parts = {{.outer = {shown.position.xyz.head<2>()}}},
         .values = {std::string(word_of(change.kind)), earlier.types[shown.type].name, uid_of(change),
                    uid(was), uid(is),
                    change.kind == ChangeKind::moved ? AttributeValue(change.distance) : AttributeValue(),
                    confidence}});
  }
  return layer;
}

}  // namespace waymark::workflows
