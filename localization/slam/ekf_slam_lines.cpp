// SPDX-License-Identifier: Apache-2.0
// Lines, such as walls, as landmarks of SLAM.
#include <algorithm>
#include <cmath>

#include "localization/slam/ekf_slam.hpp"

namespace waymark::localization {

void state_as_position(SlamLandmark& landmark) {
  const SlamLine& line = *landmark.line;
  const LinePosition position = line_position(line, landmark.at, landmark.covariance);
  landmark.at = position.at, landmark.covariance = position.covariance;
  const double length = line.to - line.from;
  for (KnownFeatures& sample : landmark.feature_samples) {
    sample.value[line.direction] = wrap_angle(position.azimuth - sample.value[line.direction]);
    sample.value[line.length] = length;
  }
  if (landmark.was_mapped) return;
  landmark.features.value[line.direction] = position.azimuth;
  landmark.features.variance[line.direction] = position.azimuth_variance;
  landmark.features.value[line.length] = length;
}

// Sets position and covariance to those of the map.
void EkfSlam::set_as_mapped(SlamLandmark& landmark, const MapLandmark& known) const {
  landmark.at = known.at, landmark.covariance = known.covariance;
  const auto features = scales_.line(known.type);
  if (!features || !known.is_line()) return;
  constexpr double kMinTurnVariance = 1e-6;  // rad^2: a map may state none
  landmark.line = slam_line(known, *features);
  landmark.at = Eigen::Vector2d::Zero();
  landmark.covariance = Eigen::Vector2d(known.normal.dot(known.covariance * known.normal),
                                        std::max(known.normal_variance, kMinTurnVariance))
                            .asDiagonal();
}

void EkfSlam::add_line(const SeenLandmark& seen, const Pose2& mount) {
  const Pose2 sensor = state_.pose() * mount;
  SlamLandmark fresh;
  fresh.line = slam_line(seen, sensor, *scales_.line(*seen.type));
  const ExpectedSighting e = expect(state_.pose(), mount, *fresh.line, fresh.at);
  const Eigen::Matrix2d back = e.by_landmark.inverse();
  fresh.slot =
      state_.add(fresh.at, -back * e.by_pose, back * line_noise(seen, *fresh.line) * back.transpose());
  fresh.type = seen.type;
  fresh.matches = fresh.expected = 1;
  see_piece(fresh, seen, sensor);
  landmark_by_slot_.resize(*fresh.slot + 1);
  landmark_by_slot_[*fresh.slot] = landmarks_.size();
  landmarks_.push_back(std::move(fresh));
}

// Extends a line by a piece. Its samples are deviations from the line, whose direction is an unknown. A line
// of the map keeps its ends.
void EkfSlam::see_piece(SlamLandmark& landmark, const SeenLandmark& seen, const Pose2& sensor) {
  SlamLine& line = *landmark.line;
  const Eigen::Vector2d state = state_.at(*landmark.slot);
  if (!landmark.was_mapped) extend(line, state, *seen.extent, sensor.at());
  state_.set_site(*landmark.slot, line.anchor, std::max(-line.from, line.to));
  if (landmark.feature_samples.size() >= 100) return;
  KnownFeatures sample = seen.features;
  const double expected = std::atan2(line.normal.y(), line.normal.x()) + state[1] - sensor.yaw;
  sample.value[line.direction] = wrap_angle(seen.features.value[line.direction] - expected);
  landmark.feature_samples.push_back(sample);
}

// Returns whether a sighting may be a further piece of a line that another one of its set started.
bool EkfSlam::continues_line(const SeenLandmark& piece, const SightingSet& seen) const {
  const std::vector<std::optional<LandmarkKey>> unknown(1);
  return compare_with_landmarks({&piece, 1}, landmarks_in_reach(seen), landmarks_, unknown, scales_, options_)
             .comparisons[0]
             .min_squares <= options_.fresh;
}

}  // namespace waymark::localization
