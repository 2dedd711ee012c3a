// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/detection_projection.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "pipeline/fusion/projection/crest_correction.hpp"
#include "pipeline/fusion/projection/ground_outline.hpp"
#include "pipeline/fusion/projection/local_ground_plane.hpp"
#include "pipeline/fusion/projection/position_covariance.hpp"

namespace waymark::pipeline {
namespace {

constexpr int kAzimuths = 36;

// Heights of a crater measured in the terrain.
struct BowlDepth {
  double rim_height = 0;  // metres, median of the crest over 36 azimuths
  double depth = 0;       // metres, rim height minus floor (lowest tenth within 0.4 radii); may be negative
  double depth_sd = 0;    // from heights and rim unevenness; excludes shape errors of a coarse terrain
};

// Returns the height at `fraction` of the semi-axes and phase t of the ellipse.
std::optional<double> height_at(const Terrain& terrain, const GroundOutline& o, double t, double fraction) {
  const double along = fraction * o.major / 2 * std::cos(t), across = fraction * o.minor / 2 * std::sin(t);
  const double s = std::sin(o.orientation), c = std::cos(o.orientation);
  return terrain.height(o.centre.x() + along * s + across * c, o.centre.y() + along * c - across * s);
}

double nth(std::vector<double>& values, std::size_t n) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(n), values.end());
  return values[n];
}

// `std::nullopt` if the crater is narrower than five cells of the terrain or the terrain ends inside it.
std::optional<BowlDepth> bowl_depth(const Terrain& terrain, const GroundOutline& outline) {
  const double cell = std::max(terrain.step_x(), terrain.step_y());
  if (!(outline.minor >= 5 * cell)) return std::nullopt;
  std::vector<double> rim, floor;
  for (int k = 0; k < kAzimuths; ++k) {
    const double t = 2 * std::numbers::pi * k / kAzimuths;
    std::optional<double> crest;
    for (const double fraction : {0.9, 0.94, 0.98, 1.02, 1.06, 1.1}) {
      const auto h = height_at(terrain, outline, t, fraction);
      if (!h) return std::nullopt;
      crest = std::max(crest.value_or(*h), *h);
    }
    rim.push_back(*crest);
    for (const double fraction : {0.06, 0.16, 0.28, 0.4}) {
      const auto h = height_at(terrain, outline, t, fraction);
      if (!h) return std::nullopt;
      floor.push_back(*h);
    }
  }
  const double rim_height = nth(rim, rim.size() / 2);
  const double spread = (nth(rim, rim.size() * 84 / 100) - nth(rim, rim.size() * 16 / 100)) / 2;
  // Heights along a rim are correlated over about a sixth of its circumference.
  const double uneven = spread * 1.25 / std::sqrt(6.0);
  return BowlDepth{rim_height, rim_height - nth(floor, floor.size() / 10),
                   std::hypot(terrain.height_sd(), uneven)};
}

Observation reject(Observation observation, const char* reason) {
  observation.position.xyz.setConstant(std::nan(""));
  observation.rejected = reason;
  return observation;
}

const char* why_no_ground(RayEnd end) {
  switch (end) {
    case RayEnd::sky:
      return "no ground in its line of sight";
    case RayEnd::no_data:
      return "height of the ground unknown";
    case RayEnd::underground:
      return "camera under the ground";
    case RayEnd::ground:
      break;
  }
  return "";
}

// Fits a plane through a crater's rim where the terrain shows it.
std::optional<GroundPlane> rim_plane(const ImageView& image, const PixelEllipse& outline,
                                     const Terrain& terrain) {
  constexpr int kPoints = 24;
  std::vector<Eigen::Vector3d> rim;
  for (int k = 0; k < kPoints; ++k) {
    const auto line = viewing_ray(image, outline_point(outline, 2 * std::numbers::pi * k / kPoints));
    if (!line) continue;
    const RayHit hit = terrain.cast(*line);
    if (hit.end == RayEnd::ground) rim.push_back(hit.point.xyz);
  }
  if (rim.size() < kPoints * 2 / 3) return std::nullopt;  // half a rim does not define a plane
  return fit_plane(rim);
}

void set(Observation& observation, const LandmarkType& type, std::string_view feature, double value,
         double sd) {
  for (std::size_t i = 0; i < type.features.size(); ++i)
    if (type.features[i].name == feature && std::isfinite(value))
      observation.features[i] = {value, std::isfinite(sd) ? sd * sd : 0, 1};
}

// Returns the standard deviation of the direction of an ellipse's axis: difference of the axes against their
// errors.
double orientation_sd(const GroundOutline& o, double diameter_sd) {
  const double sd = std::atan2(diameter_sd, std::max(o.major - o.minor, 0.0));
  return std::min(sd, std::numbers::pi / 4);
}

}  // namespace

std::optional<MeasuredValue> height_from_shadow(const MeasuredValue& reach_px, const ImageView& image,
                                                const GroundPlane& ground, const Sun& sun, double slope_sd,
                                                double slope_response) {
  const Eigen::Vector3d light = sun_direction(sun).unit;
  const double level = light.head<2>().norm();
  if (!(light.z() > 0) || !(level > 1e-6)) return std::nullopt;
  const Eigen::Vector2d away = -light.head<2>() / level;
  const double rise = ground.gradient.dot(away);
  if (!(light.z() / level + rise > 0.02)) return std::nullopt;
  const double per_metre = light.z() / level + slope_response * rise;  // height per level metre of shadow

  const Eigen::Vector3d step(away.x(), away.y(), rise);
  const auto from = project_to_image(image, {ground.at - 0.5 * step}),
             to = project_to_image(image, {ground.at + 0.5 * step});
  if (!from || !to) return std::nullopt;
  const double pixels_per_metre = (*to - *from).norm();
  if (!(pixels_per_metre > 0)) return std::nullopt;

  const double length = reach_px.value / pixels_per_metre, length_sd = reach_px.sd / pixels_per_metre;
  const double cosine2 = level * level;  // of the elevation
  const double from_sun = length / cosine2 * to_radians(sun.sd).value;
  return MeasuredValue{
      length * per_metre,
      std::hypot(per_metre * length_sd, std::hypot(from_sun, length * slope_response * slope_sd))};
}

double log_shadow_shortening(const GroundPlane& ground, const Sun& sun) {
  const Eigen::Vector3d light = sun_direction(sun).unit;
  const double level = light.head<2>().norm();
  if (!(light.z() > 0) || !(level > 1e-6)) return 0;
  const double rise = -ground.gradient.dot(light.head<2>()) / level;
  return std::log(std::clamp(1 + rise * level / light.z(), 0.5, 2.0));
}

Observation project_detection(const Detection& detection, const ImageView& image, const Terrain& terrain,
                              const LandmarkType& type, const ProjectionRules& rules) {
  Observation observation;
  observation.type = detection.type;
  observation.source = image.name;
  observation.pixel = Eigen::Vector2d(detection.outline.x, detection.outline.y);
  observation.confidence = detection.confidence;
  observation.features.resize(type.features.size());

  const auto line = viewing_ray(image, *observation.pixel);
  if (!line) return reject(observation, "outside the lens model");
  const RayHit hit = terrain.cast(*line);
  if (hit.end != RayEnd::ground) return reject(observation, why_no_ground(hit.end));
  const double cell = std::max(terrain.step_x(), terrain.step_y());
  auto ground = local_ground_plane(terrain, hit.point.xyz.x(), hit.point.xyz.y(), cell);
  if (!ground) ground = GroundPlane{hit.point.xyz, Eigen::Vector2d::Zero()};
  auto outline = project_outline(image, detection.outline, *ground);
  if (!outline) return reject(observation, "seen too flat");

  const bool bowl = type.evidence == EvidenceModel::bowl;
  if (bowl && outline->diameter() >= 4 * cell)
    if (const auto rim = rim_plane(image, detection.outline, terrain))
      if (const auto on_rim = project_outline(image, detection.outline, *rim)) outline = on_rim, ground = rim;
  double growth_sd = 0;
  if (bowl && rules.heights_known && rules.outline_edge_fraction > 0)
    if (const auto crest = crest_correction(terrain, *outline, rules.outline_edge_fraction)) {
      outline->major *= std::exp(crest->growth), outline->minor *= std::exp(crest->growth);
      growth_sd = crest->growth_sd;
    }
  double diameter = outline->diameter();
  if (!bowl && diameter > 2 * cell)
    if (const auto wider = local_ground_plane(terrain, outline->centre.x(), outline->centre.y(), diameter))
      ground->gradient = wider->gradient;
  if (detection.diameter_slope_response > 0 && image.sun)
    diameter *= std::exp(detection.diameter_slope_response * log_shadow_shortening(*ground, *image.sun));

  const auto pixel_sd = detection.diameter_sd / std::max(detection.outline.diameter(), 1e-3);
  const auto range_sd = relative_range_sd(image, *line, hit.range);
  const double diameter_sd = diameter * std::hypot(pixel_sd, range_sd, growth_sd);
  if (!type.body.feature.empty()) {
    const double per_diameter = 1 / (2 * type.body.radius_per_value);
    set(observation, type, type.body.feature, per_diameter * diameter, per_diameter * diameter_sd);
  }
  set(observation, type, "major_axis", outline->major, diameter_sd * std::sqrt(2.0));
  set(observation, type, "minor_axis", outline->minor, diameter_sd * std::sqrt(2.0));
  set(observation, type, "orientation", outline->orientation, orientation_sd(*outline, diameter_sd));
  if (detection.shadow_reach && image.sun)
    if (const auto height = height_from_shadow(*detection.shadow_reach, image, *ground, *image.sun,
                                               rules.slope_sd, detection.reach_slope_response))
      set(observation, type, "height", height->value, std::hypot(height->sd, height->value * range_sd));

  double z = outline->centre.z();
  if (!bowl) {
    if (const auto h = terrain.height(outline->centre.x(), outline->centre.y())) z = *h;
  } else if (rules.heights_known) {
    if (const auto depth = bowl_depth(terrain, *outline)) {
      z = depth->rim_height;
      const double growth = depth_growth(depth->depth / diameter, diameter / cell);
      set(observation, type, "depth", growth * depth->depth, std::max(growth * depth->depth_sd, 1e-6));
    }
  }
  observation.position.xyz << outline->centre.head<2>(), z;
  observation.covariance =
      position_covariance(detection, image, *ground,
                          {.height_sd = terrain.height_sd() > 0 ? terrain.height_sd() : rules.height_sd,
                           .along_sun_sd = detection.shadow_reach ? rules.shadow_shape * diameter : 0,
                           .isotropic_sd = bowl ? rules.rim_shape * diameter : 0});
  if (!rules.heights_known) {
    observation.covariance.row(2).setConstant(std::nan(""));
    observation.covariance.col(2).setConstant(std::nan(""));
  }
  return observation;
}

}  // namespace waymark::pipeline
