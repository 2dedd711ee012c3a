// SPDX-License-Identifier: Apache-2.0
#include "localization/sensor_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/error.hpp"
#include "core/solve.hpp"

namespace waymark::localization {
namespace {

constexpr double kEnclosed = 0.99;       // of matched sightings, by range and view
constexpr double kRimOfView = 0.95;      // of range and view, beyond which detections are not expected
constexpr std::size_t kMinMatches = 30;  // a standard deviation is known to an eighth

/// One sighting and its landmark.
struct SensorResidual {
  double range = 0, bearing = 0;  // of the landmark, from the sensor
  std::optional<double> range_error;
  std::optional<double> bearing_error = {};
  double along = 0, across = 0;  // m^2, variances of the map's position
};

/// One landmark in range and view.
struct DetectionTrial {
  double range = 0, diameter = 0;
  bool detected = false;
};

double enclosing_value(std::vector<double> values) {
  const auto at = static_cast<std::size_t>(kEnclosed * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(at));
  return values[at];
}

/// Returns the standard deviation of the values within three of them about their mean.
double trimmed_sd(std::vector<double> values) {
  for (int round = 0;; ++round) {
    double mean = 0, squares = 0;
    for (const double v : values) mean += v / static_cast<double>(values.size());
    for (const double v : values) squares += (v - mean) * (v - mean);
    const double sd = std::sqrt(squares / std::max(1.0, static_cast<double>(values.size()) - 1));
    if (std::erase_if(values, [&](double v) { return std::abs(v - mean) > 3 * sd; }) == 0 || round == 20)
      return sd;
  }
}

/// Returns the landmark of each sighting of a set: nearest pairs first, one to one.
std::vector<std::optional<std::uint32_t>> nearest_landmarks(const SightingsAtTruth& set,
                                                            const LandmarkGrid& map, double max_error,
                                                            double bearing_reach) {
  struct Pair {
    double distance;
    std::size_t sighting;
    std::uint32_t landmark;
  };
  const Pose2 sensor = set.robot * set.seen.robot_from_sensor;
  std::vector<Pair> pairs;
  for (std::size_t k = 0; k < set.seen.sightings.size(); ++k) {
    const SeenLandmark& s = set.seen.sightings[k];
    if (!s.is_valid() || s.type == kNoSuchType) continue;
    // A range alone shows a landmark only by its identity.
    if (!s.bearing && !(s.identity && map.find(*s.identity))) continue;
    const double along = sensor.yaw + s.bearing.value_or(0);
    const Eigen::Vector2d direction(std::cos(along), std::sin(along));
    const auto consider = [&](std::uint32_t i) {
      const MapLandmark& l = map[i];
      if (!s.may_be(l.type)) return;
      if (s.identity && *s.identity != l.key && map.find(*s.identity)) return;
      const Eigen::Vector2d to = l.at - sensor.at();
      const double distance =
          !s.bearing ? std::abs(to.norm() - *s.range)
          : s.range  ? (to - *s.range * direction).norm()
                     : (to.dot(direction) > 0 ? std::abs(to.x() * direction.y() - to.y() * direction.x())
                                              : std::numeric_limits<double>::infinity());
      if (distance <= max_error) pairs.push_back({distance, k, i});
    };
    if (!s.bearing)
      map.near(sensor.at(), *s.range + max_error, consider);
    else if (s.range)
      map.near(sensor.at() + *s.range * direction, max_error, consider);
    else
      map.near(sensor.at(), bearing_reach, consider);
  }
  std::ranges::stable_sort(pairs, {}, &Pair::distance);
  std::vector<std::optional<std::uint32_t>> landmark(set.seen.sightings.size());
  for (const Pair& p : pairs)
    if (!landmark[p.sighting] && std::ranges::find(landmark, p.landmark) == landmark.end())
      landmark[p.sighting] = p.landmark;
  return landmark;
}

SensorResidual residual_of(const SeenLandmark& s, const Pose2& sensor, const MapLandmark& l) {
  const Eigen::Vector2d to = l.at - sensor.at();
  SensorResidual r{
      .range = to.norm(), .bearing = wrap_angle(std::atan2(to.y(), to.x()) - sensor.yaw), .range_error = {}};
  if (s.range) r.range_error = *s.range - r.range;
  if (s.bearing) r.bearing_error = wrap_angle(*s.bearing - r.bearing);
  const Eigen::Vector2d u = to / std::max(r.range, 1e-6), w(-u.y(), u.x());
  r.along = u.dot(l.covariance * u);
  r.across = w.dot(l.covariance * w) / std::max(r.range * r.range, 1e-6);
  return r;
}

/// Logistic regression by Newton's method; a weak prior keeps it finite where all are detected.
DetectionOdds fit_odds(std::span<const DetectionTrial> trials) {
  Eigen::Vector3d odds = Eigen::Vector3d::Zero();
  for (int round = 0; round < 50; ++round) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Identity() * 0.01;
    Eigen::Vector3d gradient = -0.01 * odds;
    for (const DetectionTrial& t : trials) {
      const Eigen::Vector3d x(1, t.range, std::log(t.diameter));
      const double p = 1 / (1 + std::exp(-odds.dot(x)));
      gradient += (t.detected - p) * x;
      information += std::max(p * (1 - p), 1e-9) * x * x.transpose();
    }
    Eigen::Vector3d step = solve_symmetric<3>(information, gradient);
    if (const double length = step.norm(); length > 2) step *= 2 / length;
    odds += step;
    if (step.norm() < 1e-9) break;
  }
  return {odds[0], odds[1], odds[2]};
}

}  // namespace

SensorFit fit_sensor(std::span<const SightingsAtTruth> sets, const LandmarkGrid& map, double max_error) {
  constexpr double kBearingReach = 100;  // m
  std::vector<std::vector<std::optional<std::uint32_t>>> landmark_of;
  std::vector<SensorResidual> residuals;
  for (const SightingsAtTruth& set : sets) {
    landmark_of.push_back(nearest_landmarks(set, map, max_error, kBearingReach));
    const Pose2 sensor = set.robot * set.seen.robot_from_sensor;
    for (std::size_t k = 0; k < set.seen.sightings.size(); ++k)
      if (const auto l = landmark_of.back()[k])
        residuals.push_back(residual_of(set.seen.sightings[k], sensor, map[*l]));
  }
  if (residuals.size() < kMinMatches)
    throw Error(ErrorCode::input,
                fmt::format("only {} sightings lie within {:g} m of a landmark; {} are needed",
                            residuals.size(), max_error, kMinMatches),
                "", "are map and true poses in one frame, and are the types of the sightings in the map?");

  SensorFit fit{.coverage = {}, .matched = residuals.size()};
  std::vector<double> ranges, bearings, range_errors, bearing_errors;
  double along = 0, across = 0;
  for (const SensorResidual& r : residuals) {
    ranges.push_back(r.range), bearings.push_back(std::abs(r.bearing));
    if (r.range_error) range_errors.push_back(*r.range_error);
    if (r.bearing_error) bearing_errors.push_back(*r.bearing_error);
    along += r.along / static_cast<double>(residuals.size());
    across += r.across / static_cast<double>(residuals.size());
  }
  SensorCoverage& coverage = fit.coverage;
  const auto noise = [](std::vector<double> errors, double map_variance) {
    const double sd = trimmed_sd(std::move(errors));
    return std::sqrt(std::max(sd * sd - map_variance, 0.01 * sd * sd));
  };
  const double half_view = enclosing_value(bearings);
  coverage.range = enclosing_value(ranges);
  coverage.view = std::min(360.0, 2 * half_view / std::numbers::pi * 180);
  coverage.range_sd = range_errors.size() < kMinMatches ? 0 : noise(range_errors, along);
  if (bearing_errors.size() >= kMinMatches)
    coverage.bearing_sd = noise(bearing_errors, across) / std::numbers::pi * 180;

  std::vector<DetectionTrial> trials;
  std::size_t detected = 0;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    const Pose2 sensor = sets[i].robot * sets[i].seen.robot_from_sensor;
    map.near(sensor.at(), kRimOfView * coverage.range, [&](std::uint32_t l) {
      const Eigen::Vector2d to = map[l].at - sensor.at();
      if (std::abs(wrap_angle(std::atan2(to.y(), to.x()) - sensor.yaw)) > kRimOfView * half_view) return;
      const bool found = std::ranges::find(landmark_of[i], std::optional(l)) != landmark_of[i].end();
      ++fit.expected, detected += found;
      if (map[l].diameter > 0) trials.push_back({to.norm(), map[l].diameter, found});
    });
  }
  coverage.detection = std::clamp(
      static_cast<double>(detected) / std::max(1.0, static_cast<double>(fit.expected)), 0.001, 0.999);
  if (trials.size() >= kMinMatches) coverage.detection_odds = fit_odds(trials);
  return fit;
}

}  // namespace waymark::localization
