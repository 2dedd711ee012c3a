// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/association/repetition.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "geo/spatial_index.hpp"
#include "pipeline/fusion/association/body_radius.hpp"
#include "pipeline/fusion/association/map_plane.hpp"
#include "pipeline/fusion/valuation/image_coverage.hpp"

namespace waymark::pipeline {
namespace {

/// Object of an image with what visible_gsd needs.
struct SeenBody {
  ObservedObject object;
  VisibilityTarget target;
};

/// Returns false where the suns of two images are known to differ so much that other shadows are seen.
bool same_light(const ImageView& a, const ImageView& b) {
  constexpr double kTurn = 20;  // degrees
  if (!a.sun || !b.sun) return true;
  return std::abs(std::remainder(a.sun->azimuth.value - b.sun->azimuth.value, 360)) <= kTurn &&
         std::abs(a.sun->elevation.value - b.sun->elevation.value) <= kTurn;
}

/// Objects of one image and their index.
class BodiesOfImage {
 public:
  BodiesOfImage(std::vector<SeenBody> bodies, const MapPlane& plane, const AssociationRules& rules)
      : bodies_(std::move(bodies)), plane_(plane), rules_(rules), index_(positions(bodies_, plane)) {
    for (const SeenBody& body : bodies_) reach_ = std::max(reach_, gate_radius(body.object, rules));
  }

  bool has_partner(const ObservedObject& object) const {
    const double radius = gate_radius(object, rules_) + reach_;
    for (const std::size_t i : index_.within(plane_.to_cartesian(object.at), radius))
      if (bodies_[i].object.type == object.type &&
          association_cost(object, bodies_[i].object, plane_, rules_))
        return true;
    return false;
  }

 private:
  static std::vector<Eigen::Vector3d> positions(const std::vector<SeenBody>& bodies, const MapPlane& plane) {
    std::vector<Eigen::Vector3d> all;
    for (const SeenBody& body : bodies) all.push_back(plane.to_cartesian(body.object.at));
    return all;
  }

  std::vector<SeenBody> bodies_;
  const MapPlane& plane_;
  const AssociationRules& rules_;
  SpatialIndex index_;
  double reach_ = 0;
};

}  // namespace

Repetition measure_repetition(std::span<const Observation> observations, std::span<const ImageView> images,
                              const TypeRegistry& types, const Crs& crs, const RepetitionRules& rules) {
  const MapPlane plane(crs);
  const double metres_per_unit = crs.metres_per_unit();
  std::map<std::string_view, std::uint32_t> number;
  for (std::uint32_t i = 0; i < images.size(); ++i) number.emplace(images[i].name, i);
  std::vector<std::vector<SeenBody>> all(images.size());
  std::vector<SeenBody> asked;
  for (const Observation& o : observations) {
    const auto image = number.find(o.source);
    if (!o.rejected.empty() || image == number.end()) continue;
    const auto body = body_radius(body_index(types[o.type]), o.features);
    const double gsd = images[image->second].gsd;
    if (!body || !(gsd > 0)) continue;
    const double sd = rules.sd_of_gsd * gsd + rules.sd_of_radius * body->metres;
    SeenBody seen;
    seen.object = {.at = o.position.xyz.head<2>(),
                   .covariance = sd * sd * Eigen::Matrix2d::Identity(),
                   .log_size = std::log(body->metres),
                   .log_size_variance = body->log_variance,
                   .type = o.type,
                   .source = image->second};
    seen.target = {Eigen::Vector3d(o.position.xyz.x() * metres_per_unit, o.position.xyz.y() * metres_per_unit,
                                   o.position.xyz.z()),
                   body->metres};
    if (o.confidence >= rules.min_confidence) asked.push_back(seen);
    all[image->second].push_back(std::move(seen));
  }
  // The covariances are in question here, so the gates follow from the sizes of pixels and bodies.
  AssociationRules gates = rules.association;
  gates.overlap = 0;
  std::vector<BodiesOfImage> shown;
  double typical = 0;
  for (auto& bodies : all) shown.emplace_back(std::move(bodies), plane, gates);
  for (const SeenBody& body : asked) typical += gate_radius(body.object, gates);
  if (!asked.empty()) typical /= static_cast<double>(asked.size());

  const CoverageRules sharp{.margin = 4, .min_diameter = rules.min_diameter};
  const std::size_t step = 1 + asked.size() / std::max<std::size_t>(rules.max_objects, 1);
  Repetition found;
  std::map<std::pair<std::uint32_t, std::uint32_t>, ImagePair> pairs;
  double matches = 0, beside = 0, places = 0;
  for (std::size_t i = 0; i < asked.size(); i += step) {
    const SeenBody& body = asked[i];
    if (!visible_gsd(images[body.object.source], nullptr, body.target, sharp)) continue;
    const double away = 4 * (gate_radius(body.object, gates) + typical) + 2 * body.target.radius;
    for (std::uint32_t other = 0; other < images.size(); ++other) {
      if (other == body.object.source || !same_light(images[body.object.source], images[other]) ||
          !visible_gsd(images[other], nullptr, body.target, sharp))
        continue;
      ImagePair& pair =
          pairs.try_emplace({body.object.source, other}, ImagePair{.from = body.object.source, .to = other})
              .first->second;
      const bool is_matched = shown[other].has_partner(body.object);
      ++found.expected, ++pair.expected;
      matches += is_matched, pair.matched += is_matched;
      const std::array<Eigen::Vector2d, 4> moves{{{away, 0}, {-away, 0}, {0, away}, {0, -away}}};
      for (const Eigen::Vector2d& move : moves) {
        ObservedObject moved = body.object;
        moved.at = plane.translate(moved.at, move);
        VisibilityTarget target = body.target;
        target.at.head<2>() += move;
        if (!visible_gsd(images[other], nullptr, target, sharp)) continue;
        ++places;
        beside += shown[other].has_partner(moved);
      }
    }
  }
  for (const auto& [images_of_pair, pair] : pairs) found.pairs.push_back(pair);
  if (found.expected > 0) found.raw = matches / static_cast<double>(found.expected);
  if (places > 0) found.chance = beside / places;
  return found;
}

}  // namespace waymark::pipeline
