// SPDX-License-Identifier: Apache-2.0
#include "planning/object_hazard.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "landmarks/rock_abundance.hpp"
#include "planning/relief_hazard.hpp"

namespace waymark::planning {
namespace {

constexpr double kReach = 4;  // standard deviations

std::optional<Uncertain> feature(const Landmark& landmark, const LandmarkType& type, std::string_view name) {
  for (std::size_t i = 0; i < type.features.size() && i < landmark.features.size(); ++i)
    if (type.features[i].name == name && std::isfinite(landmark.features[i].value) &&
        landmark.features[i].observations > 0) {
      const FeatureValue& f = landmark.features[i];
      const double spread = std::sqrt(std::max(0.0, f.variance));
      const double size = std::abs(f.value);
      return Uncertain{f.value, spread > 0 ? std::hypot(spread, kCommonError * size) : kUnknownSpread * size};
    }
  return {};
}

std::optional<Uncertain> body_radius(const Landmark& landmark, const LandmarkType& type) {
  auto size = feature(landmark, type, type.body.feature);
  if (size) size->value *= type.body.radius_per_value, size->sd *= type.body.radius_per_value;
  return size;
}

double rim_is_steep(const Landmark& landmark, const LandmarkType& type, const Uncertain& radius,
                    const Vehicle& vehicle) {
  const auto depth = feature(landmark, type, "depth");
  if (!depth || !(radius.value > 0)) return 1;  // unknown depth: not ruled out
  const double slope = 2 * depth->value / radius.value;
  const double relative = std::hypot(depth->sd / std::max(depth->value, 1e-6), radius.sd / radius.value);
  return probability_above({slope, slope * relative}, std::tan(to_radians(vehicle.max_slope).value));
}

}  // namespace

HazardObject hazard_object(const Landmark& landmark, const LandmarkType& type, const Vehicle& vehicle) {
  HazardObject object{.position = landmark.position.xyz.head<2>(),
                      .covariance = landmark.covariance.topLeftCorner<2, 2>(),
                      .probability = std::clamp(landmark.confidence, 0.0, 1.0)};
  if (!object.covariance.allFinite()) object.covariance.setZero();
  std::optional<Uncertain> radius = body_radius(landmark, type);
  switch (type.evidence) {
    case EvidenceModel::shadow_caster: {
      auto height = feature(landmark, type, "height");
      if (!height && radius)
        height = Uncertain{2 * kRockHeightPerDiameter * radius->value, kUnknownSpread * radius->value};
      object.probability *= height ? probability_above(*height, vehicle.obstacle_height()) : 1;
      break;
    }
    case EvidenceModel::bowl:
      object.probability *= radius ? rim_is_steep(landmark, type, *radius, vehicle) : 1;
      break;
    case EvidenceModel::canopy:
    case EvidenceModel::upright:
      radius = feature(landmark, type, "diameter");  // of the stem
      if (radius) radius->value /= 2, radius->sd /= 2;
      break;
    case EvidenceModel::none:
      object.probability = 0;
      break;
  }
  if (radius) object.radius = radius->value, object.radius_sd = radius->sd;
  return object;
}

double reach_of(const HazardObject& object, double base_radius) {
  return base_radius + object.radius +
         kReach * std::sqrt(object.covariance.trace() + object.radius_sd * object.radius_sd);
}

double contact_probability(const HazardObject& object, const Eigen::Vector2d& point, double base_radius) {
  const Eigen::Vector2d to = point - object.position;
  const double distance = to.norm();
  const Eigen::Vector2d along = distance > 0 ? Eigen::Vector2d(to / distance) : Eigen::Vector2d::UnitX();
  const Eigen::Vector2d across(-along.y(), along.x());
  const double sd_along =
      std::sqrt(along.dot(object.covariance * along) + object.radius_sd * object.radius_sd);
  const double sd_across = std::sqrt(across.dot(object.covariance * across));
  const double reach = base_radius + object.radius;
  const double within = probability_above({reach - distance, sd_along}, 0) -
                        probability_above({-reach - distance, sd_along}, 0);
  const double beside = probability_above({reach, sd_across}, 0) - probability_above({-reach, sd_across}, 0);
  return std::max(0.0, within * beside);
}

Grid<float> object_hazard(std::span<const HazardObject> objects, const Window& window,
                          const Georeference& where, double base_radius) {
  if (objects.empty()) return Grid<float>(window.columns, window.rows);
  Grid<double> safe(window.columns, window.rows, 1);
  for (const HazardObject& object : objects) {
    if (!(object.probability > 0)) continue;
    const double reach = reach_of(object, base_radius);
    const auto clip = [](double value, std::int64_t first, std::int64_t count) {
      return static_cast<std::int64_t>(std::clamp(value, double(first), double(first + count)));
    };
    const std::int64_t c0 =
        clip(std::ceil(where.column(object.position.x() - reach)), window.column, window.columns);
    const std::int64_t c1 =
        clip(std::floor(where.column(object.position.x() + reach)) + 1, window.column, window.columns);
    const std::int64_t r0 = clip(std::ceil(where.row(object.position.y() + reach)), window.row, window.rows);
    const std::int64_t r1 =
        clip(std::floor(where.row(object.position.y() - reach)) + 1, window.row, window.rows);
    for (std::int64_t r = r0; r < r1; ++r)
      for (std::int64_t c = c0; c < c1; ++c) {
        const Eigen::Vector2d point(where.x(double(c)), where.y(double(r)));
        if ((point - object.position).squaredNorm() > reach * reach) continue;
        safe(c - window.column, r - window.row) *=
            1 - object.probability * contact_probability(object, point, base_radius);
      }
  }
  Grid<float> hazard(window.columns, window.rows);
  for (std::size_t i = 0; i < safe.cells().size(); ++i)
    hazard.cells()[i] = static_cast<float>(1 - safe.cells()[i]);
  return hazard;
}

}  // namespace waymark::planning
