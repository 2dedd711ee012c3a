// SPDX-License-Identifier: Apache-2.0
// The landmarks that SLAM compares with sightings, and those it expects to see.
#include <algorithm>
#include <cmath>

#include "core/covariance.hpp"
#include "localization/line_of_sight.hpp"
#include "localization/slam/ekf_slam.hpp"

namespace waymark::localization {
namespace {

constexpr double kRangeMargin = 10;      // m beyond the range of sightings
constexpr double kLineGap = 1.5;         // m, a door: pieces of a line on both sides are of one landmark
constexpr double kBeforeLandmark = 0.3;  // m: what stands nearer before a landmark may be the landmark

// Returns whether the beams of a scan reach a landmark, wherever it is within two standard deviations of its
// range and bearing.
bool is_in_sight(const RangeProfile& ranges, const Eigen::Vector2d& range_bearing,
                 const Eigen::Matrix2d& covariance) {
  const double range_sd = std::sqrt(std::max(covariance(0, 0), 0.0)),
               bearing_sd = std::sqrt(std::max(covariance(1, 1), 0.0));
  return ranges.reaches(range_bearing[1], 2 * bearing_sd, range_bearing[0] - 2 * range_sd - kBeforeLandmark);
}

}  // namespace

// Learns how far and how wide the sensor sees.
void EkfSlam::note_reach(const SightingSet& seen) {
  for (const SeenLandmark& s : seen.sightings) {
    if (!is_usable(s, options_)) continue;
    if (s.extent)
      line_reach_ = std::max(
          line_reach_, std::hypot(*s.range, std::max(std::abs(s.extent->from), std::abs(s.extent->to))));
    else if (!s.range)
      sees_bearings_ = true;
    else if (!s.bearing)
      heard_ = std::max(heard_, *s.range);
    else
      reach_ = std::max(reach_, *s.range), view_ = std::max(view_, std::abs(*s.bearing));
  }
}

// Makes the landmarks active that the sensor may see before `margin` metres are driven.
void EkfSlam::focus() {
  focused_ = reach() + options_.margin;
  state_.focus(focused_);
  centre_ = state_.pose().at();
}

// Returns the distance, m, up to which landmarks are compared with sightings. Not more than the sensor has
// shown: every active landmark costs time.
double EkfSlam::reach() const {
  const double seen = sees_bearings_ ? options_.max_range : std::min(options_.max_range, reach_);
  return std::max({seen, heard_, line_reach_}) + kRangeMargin;
}

// Returns active landmarks, and those of the map nearby that were not seen yet.
std::vector<SlamCandidate> EkfSlam::landmarks_in_reach(const SightingSet& seen) const {
  const Pose2 sensor = state_.pose() * seen.robot_from_sensor;
  const Eigen::Matrix3d robot = state_.covariance();
  const double reach = this->reach();
  std::vector<SlamCandidate> near;
  const double line_slack =
      kLineGap + 3 * (largest_sd(robot.topLeftCorner<2, 2>()) +
                      std::min(std::sqrt(std::max(0.0, robot(2, 2))), 1.0) * line_reach_);
  const auto look_at = [&](std::size_t l) {
    const SlamLandmark& landmark = landmarks_[l];
    const Eigen::Vector2d to = position(l) - sensor.at();
    const double range = to.norm();
    std::optional<LineExtent> extent;
    ExpectedSighting e;
    if (landmark.line) {
      const Eigen::Vector2d state = landmark.slot ? state_.at(*landmark.slot) : landmark.at;
      e = expect(state_.pose(), seen.robot_from_sensor, *landmark.line, state);
      extent = extent_from_foot(*landmark.line, state, sensor.at());
      if (std::hypot(e.value[0], std::max({0.0, extent->from, -extent->to})) > reach) return;
      extent->from -= line_slack, extent->to += line_slack;
    } else if (range > reach) {
      return;
    } else {
      e = expect(state_.pose(), seen.robot_from_sensor, position(l));
    }
    const double bearing = wrap_angle(std::atan2(to.y(), to.x()) - sensor.yaw);
    Eigen::Matrix2d covariance = e.by_pose * robot * e.by_pose.transpose();
    if (landmark.slot) {
      const Eigen::Matrix2d both = e.by_landmark * state_.cross(*landmark.slot) * e.by_pose.transpose();
      covariance += both + both.transpose();
    }
    covariance += e.by_landmark * (landmark.slot ? state_.covariance(*landmark.slot) : landmark.covariance) *
                  e.by_landmark.transpose();
    // Expects detections only within the range and view that the sensor has shown, and where nothing hides
    // them. With a map nothing counts as hidden: what is expected also decides whether the robot is lost.
    const bool in_view = !landmark.line && range < std::min(options_.max_range, reach_) &&
                         std::abs(bearing) < std::min(options_.field_of_view, 0.9 * view_) &&
                         (!visible_ || visible_(sensor, position(l))) &&
                         (!map_.empty() || !seen.ranges || is_in_sight(*seen.ranges, e.value, covariance));
    const bool expected = in_view && range < 0.7 * std::min(options_.max_range, reach_);
    near.push_back({l, expected, e, covariance, extent, in_view});
  };
  for (const SlamState::Slot slot : state_.active())
    if (const std::size_t l = landmark_by_slot_[slot]; landmarks_[l].slot == slot) look_at(l);
  map_.near(sensor.at(), reach + map_.max_half_length(), [&](std::uint32_t i) {
    if (!landmarks_[i].slot && !landmarks_[i].gone) look_at(i);
  });
  return near;
}

}  // namespace waymark::localization
