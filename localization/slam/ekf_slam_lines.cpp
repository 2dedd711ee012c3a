// SPDX-License-Identifier: Apache-2.0
// Lines, such as walls, as landmarks of SLAM.
#include <algorithm>
#include <cmath>

#include "localization/slam/ekf_slam.hpp"

namespace waymark::localization {
namespace {

constexpr std::size_t kMaxPieces = 8;  // of a line, with a deviation of their own

}  // namespace

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
  landmark.line = slam_line(known, *features);
  landmark.at = Eigen::Vector2d::Zero();
  landmark.covariance = line_covariance(known);
}

// The line and the deviation of its first piece depend on each other: their sum was measured.
void EkfSlam::add_line(const SeenLandmark& seen, const Pose2& mount) {
  const Pose2 sensor = state_.pose() * mount;
  const std::size_t index = landmarks_.size();
  SlamLandmark& fresh = landmarks_.emplace_back();
  fresh.line = slam_line(seen, sensor, *scales_.line(*seen.type));
  fresh.type = seen.type;
  fresh.matches = fresh.expected = 1;
  const ExpectedSighting e = expect(state_.pose(), mount, *fresh.line, fresh.at);
  const Eigen::Matrix2d back = e.by_landmark.inverse();
  const Eigen::Matrix2d noise = back * line_noise(seen, *fresh.line) * back.transpose();
  if (has_deviations(*seen.extent)) {
    const LinePiece now = sighted_piece(*fresh.line, fresh.at, *seen.extent, sensor.at());
    const PieceDeviation d = piece_deviation(*seen.extent, now, now);
    const LinePiece& piece = find_piece(index, now, d.covariance);
    fresh.slot = state_.add(fresh.at, -back * e.by_pose, noise, piece.slot, -back * d.by_deviation);
  } else {
    fresh.slot = state_.add(fresh.at, -back * e.by_pose, noise);
  }
  landmark_by_slot_.resize(*fresh.slot + 1);
  landmark_by_slot_[*fresh.slot] = index;
  see_piece(fresh, seen, sensor);
}

// Returns the piece of a line that a sighted one deviates like, which is then the one seen last.
const LinePiece& EkfSlam::find_piece(std::size_t landmark, const LinePiece& now,
                                     const Eigen::Matrix2d& covariance) {
  std::vector<LinePiece>& pieces = landmarks_[landmark].line->pieces;
  if (const auto best = localization::find_piece(pieces, now); best != pieces.end()) {
    std::rotate(best, best + 1, pieces.end());
    return pieces.back();
  }
  if (pieces.size() >= kMaxPieces) {
    state_.remove(pieces.front().slot);
    pieces.erase(pieces.begin());
  }
  pieces.push_back(now);
  pieces.back().slot = state_.add(Eigen::Vector2d::Zero(), covariance);
  landmark_by_slot_.resize(pieces.back().slot + 1);
  landmark_by_slot_[pieces.back().slot] = landmark;
  return pieces.back();
}

SlamState::Correction EkfSlam::line_correction(std::size_t landmark, const SeenLandmark& seen,
                                               const Pose2& mount) {
  const SlamLandmark& l = landmarks_[landmark];
  const Eigen::Vector2d state = state_.at(*l.slot);
  const ExpectedSighting e = expect(state_.pose(), mount, *l.line, state);
  SlamState::Correction c{.slot = *l.slot,
                          .innovation = line_innovation(seen, *l.line, e.value),
                          .by_pose = e.by_pose,
                          .by_landmark = e.by_landmark,
                          .noise = line_noise(seen, *l.line) / l.noise_divisor};
  if (!has_deviations(*seen.extent)) return c;
  const LinePiece now = sighted_piece(*l.line, state, *seen.extent, (state_.pose() * mount).at());
  const LinePiece& piece = find_piece(landmark, now, piece_deviation(*seen.extent, now, now).covariance);
  set_site(l);
  c.deviation = piece.slot;
  c.by_deviation = piece_deviation(*seen.extent, piece, now).by_deviation;
  c.innovation -= c.by_deviation * state_.at(piece.slot);
  return c;
}

// The neighbourhood of a line has its pieces as well.
void EkfSlam::set_site(const SlamLandmark& landmark) {
  const SlamLine& line = *landmark.line;
  const double radius = std::max(-line.from, line.to);
  state_.set_site(*landmark.slot, line.anchor, radius);
  for (const LinePiece& piece : line.pieces) state_.set_site(piece.slot, line.anchor, radius);
}

// Extends a line by a piece. Its samples are deviations from the line, whose direction is an unknown. A line
// of the map keeps its ends.
void EkfSlam::see_piece(SlamLandmark& landmark, const SeenLandmark& seen, const Pose2& sensor) {
  SlamLine& line = *landmark.line;
  const Eigen::Vector2d state = state_.at(*landmark.slot);
  if (!landmark.was_mapped) extend(line, state, *seen.extent, sensor.at());
  set_site(landmark);
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
