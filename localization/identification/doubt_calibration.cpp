// SPDX-License-Identifier: Apache-2.0
#include "localization/identification/doubt_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "localization/filters/measurement.hpp"

namespace waymark::localization {
namespace {

constexpr double kGate = 9.21;      // chi-square of two numbers, 0.99
constexpr double kMaxChance = 0.2;  // sightings in a gate by chance: more say nothing
// Expected sightings that count as seen before any is known. One landmark stays in view for some ten sets.
constexpr double kPrior = 10;

// Returns whether a sighting may show a landmark of this expected range and bearing. `area`: of the gate,
// metres times radians.
bool is_in_gate(const SeenLandmark& seen, const ExpectedSighting& expected, const Eigen::Matrix2d& covariance,
                double& area) {
  const Eigen::Matrix2d s = covariance + sensor_noise(seen);
  area = std::numbers::pi * kGate * std::sqrt(std::max(0.0, s.determinant()));
  return squared_distance(seen, innovation(seen, expected.value), s) < kGate;
}

}  // namespace

void DoubtCalibration::add(const SightingSet& seen, std::span<const LandmarkKey> shown,
                           const PoseEstimate& robot, const LandmarkGrid& map, const View& view) {
  const Pose2 sensor = robot.pose * seen.robot_from_sensor;
  map.near(sensor.at(), view.range, [&](std::uint32_t i) {
    const MapLandmark& l = map[i];
    if (!l.is_doubtful()) return;
    const ExpectedSighting expected = expect(robot.pose, seen.robot_from_sensor, l.at);
    if (std::abs(expected.value[1]) > view.bearing) return;
    const Eigen::Matrix2d covariance = expected.by_pose * robot.covariance * expected.by_pose.transpose() +
                                       expected.by_landmark * l.covariance * expected.by_landmark.transpose();
    bool is_comparable = false, is_seen = false;
    double largest_area = 0;
    for (std::size_t k = 0; k < seen.sightings.size(); ++k) {
      const SeenLandmark& s = seen.sightings[k];
      if (!s.is_valid() || !s.has_position() || !s.may_be(l.type)) continue;
      is_comparable = true;
      double area = 0;
      const bool inside = is_in_gate(s, expected, covariance, area);
      largest_area = std::max(largest_area, area);
      is_seen = is_seen || (inside && (shown[k] == 0 || shown[k] == l.key));
    }
    const double chance = view.clutter * largest_area;
    if (!is_comparable || chance > kMaxChance) return;
    if (l.type >= sums_.size()) sums_.resize(l.type + std::size_t{1}), factors_.resize(sums_.size(), 1);
    Sums& sums = sums_[l.type];
    sums.expected += l.quality * view.detection;
    sums.seen += (is_seen ? 1 : 0) - chance;
    factors_[l.type] = std::min(1.0, (std::max(0.0, sums.seen) + kPrior) / (sums.expected + kPrior));
  });
}

}  // namespace waymark::localization
