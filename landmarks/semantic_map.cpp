// SPDX-License-Identifier: Apache-2.0
#include "landmarks/semantic_map.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <unordered_map>

#include "geo/spatial_index.hpp"
#include "landmarks/ground.hpp"

namespace waymark {
namespace {

Point<MapCrs> middle_of(const Crs& crs, const std::vector<Landmark>& landmarks) {
  if (landmarks.empty()) return {};
  // Longitudes are averaged about the first one, so that a map across the antimeridian has its middle there.
  const bool geographic = crs.kind() == CrsKind::geographic;
  const double first = landmarks[0].position.xyz.x();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Landmark& landmark : landmarks) {
    const Eigen::Vector3d& at = landmark.position.xyz;
    sum += Eigen::Vector3d(geographic ? first + std::remainder(at.x() - first, 360) : at.x(), at.y(), 0);
  }
  return {sum / static_cast<double>(landmarks.size())};
}

double turned_home(double longitude) {  // into [-180, 180)
  return longitude - 360 * std::floor((longitude + 180) / 360);
}

// Landmarks as a flat map has them, for boxes.
std::vector<Eigen::Vector3d> flat_places(const Crs& crs, const std::vector<Landmark>& landmarks) {
  std::vector<Eigen::Vector3d> places;
  for (const Landmark& landmark : landmarks) {
    const Eigen::Vector3d& at = landmark.position.xyz;
    places.emplace_back(crs.kind() == CrsKind::geographic ? turned_home(at.x()) : at.x(), at.y(), 0);
  }
  return places;
}

std::vector<Eigen::Vector2d> ground_places(const Ground& ground, const std::vector<Landmark>& landmarks) {
  std::vector<Eigen::Vector2d> places;
  for (const Landmark& landmark : landmarks) places.push_back(ground.place(landmark.position));
  return places;
}

std::vector<Eigen::Vector3d> space_places(const Ground& ground,
                                          const std::vector<Eigen::Vector2d>& on_ground) {
  std::vector<Eigen::Vector3d> places;
  for (const Eigen::Vector2d& place : on_ground) places.push_back(ground.in_space(place));
  return places;
}

}  // namespace

struct SemanticMap::Content {
  Content(TypeRegistry all_types, Crs map_crs, std::vector<Landmark> all, const Point<MapCrs>& origin)
      : types(std::move(all_types)),
        crs(std::move(map_crs)),
        landmarks(std::move(all)),
        frame(crs, origin),
        ground(crs),
        on_ground(ground_places(ground, landmarks)),
        in_space(space_places(ground, on_ground)),
        flat(flat_places(crs, landmarks)) {
    for (std::size_t i = 0; i < landmarks.size(); ++i) by_uid.emplace(landmarks[i].uid, i);
  }

  bool keeps(const LandmarkFilter& filter, const Landmark& landmark) const {
    const LandmarkType& type = types[landmark.type];
    if (!filter.type.empty() && type.name != filter.type) return false;
    if (!(filter.min_quality > 0)) return true;
    const auto quality =
        filter.sensor ? quality_for(*filter.sensor, type, landmark) : quality_of(type, landmark);
    return quality && *quality >= filter.min_quality;
  }

  // Those of `candidates` at most `radius` from the centre, nearest first.
  Found nearest_first(const Eigen::Vector2d& centre, const std::vector<std::size_t>& candidates,
                      double radius, const LandmarkFilter& filter) const {
    std::vector<std::pair<double, std::size_t>> at;
    for (const std::size_t i : candidates) {
      if (!keeps(filter, landmarks[i])) continue;
      const double distance = ground.distance(centre, on_ground[i]);
      if (distance <= radius) at.emplace_back(distance, i);
    }
    std::ranges::sort(at);
    Found found;
    for (const auto& [distance, i] : at) found.emplace_back(landmarks[i]);
    return found;
  }

  TypeRegistry types;
  Crs crs;
  std::vector<Landmark> landmarks;
  LocalFrame frame;
  Ground ground;
  std::vector<Eigen::Vector2d> on_ground;
  SpatialIndex in_space, flat;
  std::unordered_map<std::string_view, std::size_t> by_uid;
};

SemanticMap::SemanticMap(TypeRegistry types, Crs crs, std::vector<Landmark> landmarks)
    : SemanticMap(std::move(types), crs, std::move(landmarks), middle_of(crs, landmarks)) {}

SemanticMap::SemanticMap(TypeRegistry types, Crs crs, std::vector<Landmark> landmarks,
                         const Point<MapCrs>& origin)
    : content_(
          std::make_shared<const Content>(std::move(types), std::move(crs), std::move(landmarks), origin)) {}

const TypeRegistry& SemanticMap::types() const {
  return content_->types;
}
const Crs& SemanticMap::crs() const {
  return content_->crs;
}
const LocalFrame& SemanticMap::frame() const {
  return content_->frame;
}
std::span<const Landmark> SemanticMap::landmarks() const {
  return content_->landmarks;
}

const Landmark* SemanticMap::find(std::string_view uid) const {
  const auto found = content_->by_uid.find(uid);
  return found == content_->by_uid.end() ? nullptr : &content_->landmarks[found->second];
}

SemanticMap::Found SemanticMap::where(const LandmarkFilter& filter) const {
  Found found;
  for (const Landmark& landmark : content_->landmarks)
    if (content_->keeps(filter, landmark)) found.emplace_back(landmark);
  return found;
}

SemanticMap::Found SemanticMap::in_box(const MapBox& box, const LandmarkFilter& filter) const {
  const auto between = [&](double west, double east) {
    return content_->flat.in_box({Eigen::Vector3d(west, box.south, 0), Eigen::Vector3d(east, box.north, 0)});
  };
  std::vector<std::size_t> inside;
  if (crs().kind() != CrsKind::geographic) {
    inside = between(box.west, box.east);
  } else if (box.east - box.west >= 360) {
    inside = between(-180, 180);
  } else if (const double west = turned_home(box.west), east = turned_home(box.east); west <= east) {
    inside = between(west, east);
  } else {
    inside = between(west, 180);
    std::ranges::copy(between(-180, east), std::back_inserter(inside));
    std::ranges::sort(inside);
  }
  Found found;
  for (const std::size_t i : inside)
    if (content_->keeps(filter, content_->landmarks[i])) found.emplace_back(content_->landmarks[i]);
  return found;
}

// A chord is never longer than the way over the ground, so the ball in space holds all that are near enough.
SemanticMap::Found SemanticMap::near(const Point<MapCrs>& centre, Meters radius,
                                     const LandmarkFilter& filter) const {
  const Eigen::Vector2d at = content_->ground.place(centre);
  const auto candidates =
      content_->in_space.within(content_->ground.in_space(at), radius.value * (1 + 1e-12));
  return content_->nearest_first(at, candidates, radius.value, filter);
}

SemanticMap::Found SemanticMap::near(const Point<MapFrame>& centre, Meters radius,
                                     const LandmarkFilter& filter) const {
  return near(frame().crs_from_map_frame(centre), radius, filter);
}

// Asks for more and more until enough pass the filter. The last of them is at a distance within which nothing
// is missed, although chords and ways over the ground may rank landmarks differently.
SemanticMap::Found SemanticMap::nearest(const Point<MapCrs>& centre, std::size_t count,
                                        const LandmarkFilter& filter) const {
  if (count == 0) return {};
  const Eigen::Vector2d at = content_->ground.place(centre);
  Found found;
  for (std::size_t asked = count; found.size() < count; asked *= 4) {
    const auto candidates = content_->in_space.nearest(content_->ground.in_space(at), asked);
    found = content_->nearest_first(at, candidates, HUGE_VAL, filter);
    if (candidates.size() == size()) break;
  }
  if (found.size() < count) return found;
  const Landmark& last = found[count - 1];
  found = near(centre, Meters{content_->ground.distance(at, content_->ground.place(last.position))}, filter);
  found.erase(found.begin() + static_cast<std::ptrdiff_t>(std::min(count, found.size())), found.end());
  return found;
}

}  // namespace waymark
