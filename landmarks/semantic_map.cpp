// SPDX-License-Identifier: Apache-2.0
#include "landmarks/semantic_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <unordered_map>

#include "geo/spatial_index.hpp"
#include "landmarks/surface_distance.hpp"

namespace waymark::inline landmarks {
namespace {

// FNV-1a (Fowler, Noll, Vo), 64 bits, then MurmurHash3's finaliser, so that near positions differ in all
// digits.
std::uint64_t hash(std::string_view text) {
  std::uint64_t h = 0xcbf29ce484222325u;
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  h = (h ^ (h >> 33)) * 0xff51afd7ed558ccdu;
  h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53u;
  return h ^ (h >> 33);
}

std::string base32(std::uint64_t number) {  // 13 digits contain 65 bits
  std::string digits(13, '0');
  for (auto digit = digits.rbegin(); digit != digits.rend(); ++digit, number >>= 5)
    *digit = "0123456789abcdefghjkmnpqrstvwxyz"[number & 31];
  return digits;
}

// "mt" for mountain_top, "ro" for rock.
std::string initials(std::string_view name) {
  std::string letters(1, name[0]);
  for (std::size_t i = 1; i + 1 < name.size(); ++i)
    if (name[i] == '_') letters += name[i + 1];
  return letters.size() > 1 ? letters : std::string(name.substr(0, 2));
}

struct RoundedPosition {
  std::int64_t x = 0, y = 0;
};

RoundedPosition round_position(const Crs& crs, const Point<MapCrs>& position) {
  if (crs.kind() == CrsKind::geographic) {
    constexpr std::int64_t turn = 3600000000;  // 360 degrees
    const auto x = std::llround(position.xyz.x() * 1e7) % turn;
    return {x < 0 ? x + turn : x, std::llround(position.xyz.y() * 1e7)};
  }
  const double centimetres = 100 * crs.metres_per_unit();
  return {std::llround(position.xyz.x() * centimetres), std::llround(position.xyz.y() * centimetres)};
}

Point<MapCrs> centroid(const Crs& crs, const std::vector<Landmark>& landmarks) {
  if (landmarks.empty()) return {};
  // Longitudes are averaged about the first one, so that the mean is correct across the antimeridian.
  const bool geographic = crs.kind() == CrsKind::geographic;
  const double first = landmarks[0].position.xyz.x();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Landmark& landmark : landmarks) {
    const Eigen::Vector3d& at = landmark.position.xyz;
    sum += Eigen::Vector3d(geographic ? first + std::remainder(at.x() - first, 360) : at.x(), at.y(), 0);
  }
  return {sum / static_cast<double>(landmarks.size())};
}

double wrap_longitude(double longitude) {  // into [-180, 180)
  return longitude - 360 * std::floor((longitude + 180) / 360);
}

// Returns positions in the map plane, for box queries.
std::vector<Eigen::Vector3d> planar_positions(const Crs& crs, const std::vector<Landmark>& landmarks) {
  std::vector<Eigen::Vector3d> positions;
  for (const Landmark& landmark : landmarks) {
    const Eigen::Vector3d& at = landmark.position.xyz;
    positions.emplace_back(crs.kind() == CrsKind::geographic ? wrap_longitude(at.x()) : at.x(), at.y(), 0);
  }
  return positions;
}

std::vector<Eigen::Vector2d> positions_on_surface(const SurfaceDistance& surface,
                                                  const std::vector<Landmark>& landmarks) {
  std::vector<Eigen::Vector2d> positions;
  for (const Landmark& landmark : landmarks) positions.push_back(surface.position(landmark.position));
  return positions;
}

std::vector<Eigen::Vector3d> cartesian_positions(const SurfaceDistance& surface,
                                                 const std::vector<Eigen::Vector2d>& surface_positions) {
  std::vector<Eigen::Vector3d> positions;
  for (const Eigen::Vector2d& position : surface_positions) positions.push_back(surface.cartesian(position));
  return positions;
}

}  // namespace

std::string make_uid(const LandmarkType& type, const Crs& crs, const Point<MapCrs>& position) {
  const RoundedPosition at = round_position(crs, position);
  const std::string what =
      type.name + '|' + crs.id() + '|' + std::to_string(at.x) + '|' + std::to_string(at.y);
  return initials(type.name) + '-' + base32(hash(what));
}

void assign_uids(const TypeRegistry& types, const Crs& crs, std::span<Landmark> landmarks) {
  std::unordered_map<std::string, int> taken;
  taken.reserve(landmarks.size());
  for (Landmark& landmark : landmarks) {
    landmark.uid = make_uid(types[landmark.type], crs, landmark.position);
    if (const int count = ++taken[landmark.uid]; count > 1) landmark.uid += '-' + std::to_string(count);
  }
}

struct SemanticMap::Content {
  Content(TypeRegistry all_types, Crs map_crs, std::vector<Landmark> all, const Point<MapCrs>& origin)
      : types(std::move(all_types)),
        crs(std::move(map_crs)),
        landmarks(std::move(all)),
        frame(crs, origin),
        surface(crs),
        surface_positions(positions_on_surface(surface, landmarks)),
        cartesian_index(cartesian_positions(surface, surface_positions)),
        planar_index(planar_positions(crs, landmarks)) {
    for (std::size_t i = 0; i < landmarks.size(); ++i) by_uid.emplace(landmarks[i].uid, i);
  }

  bool passes(const LandmarkFilter& filter, const Landmark& landmark) const {
    const LandmarkType& type = types[landmark.type];
    if (!filter.type.empty() && type.name != filter.type) return false;
    if (!(filter.min_quality > 0)) return true;
    const auto quality =
        filter.sensor ? quality_for(*filter.sensor, type, landmark) : quality_of(type, landmark);
    return quality && *quality >= filter.min_quality;
  }

  // Returns the candidates at most `radius` from the centre, nearest first.
  LandmarkRefs sort_by_distance(const Eigen::Vector2d& centre, const std::vector<std::size_t>& candidates,
                                double radius, const LandmarkFilter& filter) const {
    std::vector<std::pair<double, std::size_t>> at;
    for (const std::size_t i : candidates) {
      if (!passes(filter, landmarks[i])) continue;
      const double distance = surface.distance(centre, surface_positions[i]);
      if (distance <= radius) at.emplace_back(distance, i);
    }
    std::ranges::sort(at);
    LandmarkRefs found;
    for (const auto& [distance, i] : at) found.emplace_back(landmarks[i]);
    return found;
  }

  TypeRegistry types;
  Crs crs;
  std::vector<Landmark> landmarks;
  LocalFrame frame;
  SurfaceDistance surface;
  std::vector<Eigen::Vector2d> surface_positions;
  SpatialIndex cartesian_index, planar_index;
  std::unordered_map<std::string_view, std::size_t> by_uid;
};

SemanticMap::SemanticMap(TypeRegistry types, Crs crs, std::vector<Landmark> landmarks)
    : SemanticMap(std::move(types), crs, std::move(landmarks), centroid(crs, landmarks)) {}

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

SemanticMap::LandmarkRefs SemanticMap::select(const LandmarkFilter& filter) const {
  LandmarkRefs found;
  for (const Landmark& landmark : content_->landmarks)
    if (content_->passes(filter, landmark)) found.emplace_back(landmark);
  return found;
}

SemanticMap::LandmarkRefs SemanticMap::in_box(const MapBox& box, const LandmarkFilter& filter) const {
  const auto between = [&](double west, double east) {
    return content_->planar_index.in_box(
        {Eigen::Vector3d(west, box.south, 0), Eigen::Vector3d(east, box.north, 0)});
  };
  std::vector<std::size_t> inside;
  if (crs().kind() != CrsKind::geographic) {
    inside = between(box.west, box.east);
  } else if (box.east - box.west >= 360) {
    inside = between(-180, 180);
  } else if (const double west = wrap_longitude(box.west), east = wrap_longitude(box.east); west <= east) {
    inside = between(west, east);
  } else {
    inside = between(west, 180);
    std::ranges::copy(between(-180, east), std::back_inserter(inside));
    std::ranges::sort(inside);
  }
  LandmarkRefs found;
  for (const std::size_t i : inside)
    if (content_->passes(filter, content_->landmarks[i])) found.emplace_back(content_->landmarks[i]);
  return found;
}

// A chord is never longer than the geodesic, so the ball of chords contains all landmarks within the radius.
SemanticMap::LandmarkRefs SemanticMap::near(const Point<MapCrs>& centre, Meters radius,
                                            const LandmarkFilter& filter) const {
  const Eigen::Vector2d at = content_->surface.position(centre);
  const auto candidates =
      content_->cartesian_index.within(content_->surface.cartesian(at), radius.value * (1 + 1e-12));
  return content_->sort_by_distance(at, candidates, radius.value, filter);
}

SemanticMap::LandmarkRefs SemanticMap::near(const Point<MapFrame>& centre, Meters radius,
                                            const LandmarkFilter& filter) const {
  return near(frame().crs_from_map_frame(centre), radius, filter);
}

// Increases the number of candidates until enough pass the filter. Chords and geodesics may rank landmarks
// differently, so the result is the query within the geodesic distance of the last one.
SemanticMap::LandmarkRefs SemanticMap::nearest(const Point<MapCrs>& centre, std::size_t count,
                                               const LandmarkFilter& filter) const {
  if (count == 0) return {};
  const Eigen::Vector2d at = content_->surface.position(centre);
  LandmarkRefs found;
  for (std::size_t asked = count; found.size() < count; asked *= 4) {
    const auto candidates = content_->cartesian_index.nearest(content_->surface.cartesian(at), asked);
    found = content_->sort_by_distance(at, candidates, HUGE_VAL, filter);
    if (candidates.size() == size()) break;
  }
  if (found.size() < count) return found;
  const Landmark& last = found[count - 1];
  found =
      near(centre, Meters{content_->surface.distance(at, content_->surface.position(last.position))}, filter);
  found.erase(found.begin() + static_cast<std::ptrdiff_t>(std::min(count, found.size())), found.end());
  return found;
}

}  // namespace waymark::inline landmarks
