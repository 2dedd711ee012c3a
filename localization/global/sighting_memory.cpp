// SPDX-License-Identifier: Apache-2.0
#include "localization/global/sighting_memory.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <span>
#include <tuple>

#include "core/covariance.hpp"
#include "localization/filters/measurement.hpp"
#include "localization/slam/signature.hpp"

namespace waymark::localization {
namespace {

constexpr std::size_t kMaxStored = 100;  // sets
constexpr std::size_t kMaxObjects = 80;
constexpr int kMaxMissed = 10;       // sets
constexpr double kMatchGate = 13.8;  // squared distance of one object's sightings: 99.9 %, 2 dof
constexpr double kNewGate = 25;      // beyond it a sighting is of another object; between, ambiguous
constexpr double kMinSpacing = 1;    // m between two objects
constexpr double kFeatureTolerance = 0.15;
constexpr double kFeatureLimit = 9;  // squared standard deviations
constexpr double kMaxError = 1;      // m, standard deviation of a recalled object

bool may_be_same(const SeenLandmark& a, const SeenLandmark& b, const FeatureScales& scales) {
  if (a.identity || b.identity) return a.identity == b.identity;
  if (!may_share_type(a, b)) return false;
  for (std::size_t i = 0; i < kMaxFeatures; ++i) {
    if (!a.features.known(i) || !b.features.known(i)) continue;
    const double larger = std::max(std::abs(a.features.value[i]), std::abs(b.features.value[i]));
    const double d = a.type ? scales.difference(*a.type, i, a.features.value[i], b.features.value[i])
                            : a.features.value[i] - b.features.value[i];
    const double size =
        a.type ? scales.tolerance_sd(*a.type, i, larger, kFeatureTolerance) : kFeatureTolerance * larger;
    if (d * d > kFeatureLimit * (a.features.variance[i] + b.features.variance[i] + size * size)) return false;
  }
  return true;
}

// Removes the part of the errors that moves robot and objects as one body (S-transformation, Baarda 1973):
// the rigid motion that fits the objects' errors best. Order: robot, then positions.
Eigen::MatrixXd free_network(const Eigen::MatrixXd& covariance, const Pose2& robot,
                             std::span<const Eigen::Vector2d> positions) {
  const auto count = static_cast<Eigen::Index>(positions.size()), size = covariance.rows();
  if (count < 2) return covariance;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : positions) centre += p / static_cast<double>(count);
  Eigen::MatrixXd motion(size, 3);  // derivatives by x, y and a turn about the centre
  motion.topRows<3>() << 1, 0, centre.y() - robot.y, 0, 1, robot.x - centre.x(), 0, 0, 1;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Vector2d d = positions[static_cast<std::size_t>(i)] - centre;
    motion.middleRows<2>(3 + 2 * i) << 1, 0, -d.y(), 0, 1, d.x();
  }
  const auto objects = motion.bottomRows(2 * count);
  const Eigen::Matrix3d normal = objects.transpose() * objects;
  if (!(normal.determinant() > 1e-9)) return covariance;
  Eigen::MatrixXd keep = Eigen::MatrixXd::Identity(size, size);
  keep.rightCols(2 * count) -= motion * normal.inverse() * objects.transpose();
  return keep * covariance * keep.transpose();
}

// Corrections of lasting errors of the odometry leave covariances that are not positive; the submap's would
// not be, either, and turn it.
BodyMotion with_positive_covariance(BodyMotion motion) {
  motion.covariance = positive_part((motion.covariance + motion.covariance.transpose()) / 2);
  return motion;
}

bool is_usable(const SeenLandmark& s) {
  return s.is_valid() && s.has_position() && s.type != kNoSuchType;
}

}  // namespace

void SightingMemory::add(const SightingSet& seen) {
  ranges_.add(seen);
  stored_.emplace_back(std::exchange(motion_, {}), seen);
  if (stored_.size() <= kMaxStored) return;
  stored_.pop_front();
  state_.reset();  // it ends before the set that is no longer stored
  objects_.clear();
}

std::vector<SightingMemory::Candidate> SightingMemory::candidates(const SightingSet& seen,
                                                                  std::vector<bool>& is_new) const {
  std::vector<Candidate> all;
  const Eigen::Matrix3d robot = state_->covariance();
  for (const SlamState::Slot slot : state_->active()) {
    const ExpectedSighting e = expect(state_->pose(), seen.robot_from_sensor, state_->at(slot));
    const Eigen::Matrix2d both = e.by_landmark * state_->cross(slot) * e.by_pose.transpose();
    const Eigen::Matrix2d base = e.by_pose * robot * e.by_pose.transpose() + both + both.transpose() +
                                 e.by_landmark * state_->covariance(slot) * e.by_landmark.transpose();
    for (std::size_t i = 0; i < seen.sightings.size(); ++i) {
      const SeenLandmark& s = seen.sightings[i];
      if (!is_usable(s)) continue;
      const Eigen::Vector2d v = innovation(s, e.value);
      const bool same_identity = s.identity && objects_[slot].seen.identity == s.identity;
      if (s.identity && !same_identity) continue;
      const Eigen::Matrix2d spread = base + sensor_noise(s);
      const double squares = v.dot(spread.inverse() * v);
      const bool is_near = std::hypot(v[0], v[1] * e.value[0]) < kMinSpacing;
      if (squares < kNewGate || is_near || same_identity) is_new[i] = false;
      if (squares < kMatchGate && may_be_same(s, objects_[slot].seen, scales_))
        all.push_back({i, slot, squares});
    }
  }
  std::ranges::sort(all, [](const Candidate& a, const Candidate& b) {
    return std::tie(a.squares, a.sighting, a.slot) < std::tie(b.squares, b.sighting, b.slot);
  });
  return all;
}

void SightingMemory::integrate(const BodyMotion& motion, const SightingSet& set) {
  if (!state_) state_.emplace(PoseEstimate{{}, Eigen::Matrix3d::Identity() * 1e-12});
  state_->predict(with_positive_covariance(motion));
  SightingSet seen = set;
  for (SeenLandmark& s : seen.sightings) {
    if (s.type)  // angles are kept as azimuths of the memory's frame
      s.features =
          features_in_map(scales_, *s.type, s.features, state_->pose().yaw + set.robot_from_sensor.yaw);
    if (is_usable(s)) reach_ = std::max(reach_, *s.range), view_ = std::max(view_, std::abs(*s.bearing));
  }
  std::vector<bool> is_new(seen.sightings.size(), true), used = std::vector<bool>(is_new.size(), false);
  for (const SlamState::Slot slot : state_->active()) ++objects_[slot].missed;
  std::vector<SlamState::Correction> corrections;
  for (const Candidate& c : candidates(seen, is_new)) {
    Object& object = objects_[c.slot];
    if (used[c.sighting] || object.missed == 0) continue;
    used[c.sighting] = true;
    const SeenLandmark& s = seen.sightings[c.sighting];
    const ExpectedSighting e = expect(state_->pose(), seen.robot_from_sensor, state_->at(c.slot));
    corrections.push_back({.slot = c.slot,
                           .innovation = innovation(s, e.value),
                           .by_pose = e.by_pose,
                           .by_landmark = e.by_landmark,
                           .noise = sensor_noise(s)});
    const Eigen::Matrix2d back = e.by_landmark.inverse();
    const Eigen::Matrix2d noise = back * sensor_noise(s) * back.transpose();
    if (noise.trace() < object.noise.trace()) object.noise = noise;
    if (s.type) merge_signature(scales_, *s.type, object.seen.features, s.features, kFeatureTolerance);
    object.missed = 0;
    ++object.times;
  }
  state_->update(corrections);
  for (std::size_t i = 0; i < seen.sightings.size(); ++i)
    if (is_new[i] && !used[i] && is_usable(seen.sightings[i]))
      insert(seen.sightings[i], seen.robot_from_sensor);
  forget(seen);
}

void SightingMemory::insert(const SeenLandmark& seen, const Pose2& mount) {
  const Pose2 sensor = state_->pose() * mount;
  const double along = sensor.yaw + *seen.bearing;
  const Eigen::Vector2d at = sensor.at() + *seen.range * Eigen::Vector2d(std::cos(along), std::sin(along));
  const ExpectedSighting e = expect(state_->pose(), mount, at);
  const Eigen::Matrix2d back = e.by_landmark.inverse(), noise = back * sensor_noise(seen) * back.transpose();
  if (!back.allFinite()) return;
  state_->add(at, -back * e.by_pose, noise);
  objects_.push_back({.seen = seen, .noise = noise});
}

// Removes objects that were not seen again although in view, and the farthest of too many.
void SightingMemory::forget(const SightingSet& seen) {
  const Pose2 sensor = state_->pose() * seen.robot_from_sensor;
  std::vector<std::pair<double, SlamState::Slot>> by_range;
  std::vector<SlamState::Slot> gone;
  for (const SlamState::Slot slot : state_->active()) {
    const Eigen::Vector2d to = state_->at(slot) - sensor.at();
    const double range = to.norm(), bearing = wrap_angle(std::atan2(to.y(), to.x()) - sensor.yaw);
    const bool in_view = range < 0.7 * reach_ && std::abs(bearing) < 0.9 * view_;
    Object& object = objects_[slot];
    if (!in_view && object.missed > 0) --object.missed;
    if (object.missed > kMaxMissed)
      gone.push_back(slot);
    else
      by_range.emplace_back(range, slot);
  }
  for (const SlamState::Slot slot : gone) state_->remove(slot);
  std::ranges::sort(by_range);
  for (std::size_t i = kMaxObjects; i < by_range.size(); ++i) state_->remove(by_range[i].second);
}

void SightingMemory::catch_up() {
  for (const auto& [motion, seen] : stored_) integrate(motion, seen);
  stored_.clear();
}

RememberedSightings SightingMemory::recall(std::size_t max_count) {
  catch_up();
  RememberedSightings result;
  if (!state_) return result;
  SlamState now = *state_;
  now.predict(with_positive_covariance(motion_));
  std::vector<SlamState::Slot> slots;
  std::vector<Eigen::Index> rows{0, 1, 2};
  const std::vector<SlamState::Slot> chosen = nearest_objects(now, max_count);
  const Eigen::MatrixXd whole = now.full_covariance(slots);
  std::vector<Eigen::Vector2d> positions;
  for (const SlamState::Slot slot : chosen) {
    const auto row = 3 + 2 * (std::ranges::find(slots, slot) - slots.begin());
    rows.insert(rows.end(), {row, row + 1});
    positions.push_back(now.at(slot));
  }
  const Eigen::MatrixXd free = free_network(whole(rows, rows), now.pose(), positions);
  const Eigen::Matrix2d back = Eigen::Rotation2Dd(-now.pose().yaw).toRotationMatrix();
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = back;
  result.robot_covariance = turn * free.topLeftCorner<3, 3>() * turn.transpose();
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const Eigen::Index row = 3 + 2 * static_cast<Eigen::Index>(i);
    const Object& object = objects_[chosen[i]];
    const Eigen::Vector2d at = back * (positions[i] - now.pose().at());
    // An object's sightings share an error, so its position is no better than the best of them.
    const Eigen::Matrix2d covariance = back * (free.block<2, 2>(row, row) + object.noise) * back.transpose();
    const double range = at.norm();
    if (!(range > 1e-6) || !(covariance.trace() < kMaxError * kMaxError)) continue;
    const Eigen::Vector2d radial = at / range, across(-radial.y(), radial.x());
    SeenLandmark s = object.seen;
    if (s.type) s.features = features_in_map(scales_, *s.type, s.features, now.pose().yaw);  // from the robot
    s.range = range;
    s.bearing = std::atan2(at.y(), at.x());
    s.range_sd = std::sqrt(std::max(1e-12, radial.dot(covariance * radial)));
    s.bearing_sd = std::sqrt(std::max(1e-12, across.dot(covariance * across))) / range;
    result.set.sightings.push_back(s);
  }
  return result;
}

std::vector<SlamState::Slot> SightingMemory::nearest_objects(const SlamState& state,
                                                             std::size_t max_count) const {
  std::vector<SlamState::Slot> slots(state.active().begin(), state.active().end());
  std::ranges::sort(slots, {}, [&](SlamState::Slot slot) {
    return std::tuple(objects_[slot].times < 2, (state.at(slot) - state.pose().at()).norm(), slot);
  });
  if (slots.size() > max_count) slots.resize(max_count);
  return slots;
}

PoseSearchResult SightingMemory::find(const PoseFinder& finder, const SightingSet& seen) {
  RememberedSightings remembered = recall();
  SightingSet all = add_bearings(std::move(remembered.set), seen);
  all.earlier_ranges = ranges_.recall();
  const bool by_ranges = all.sightings.empty() && !all.earlier_ranges.empty();
  PoseSearchResult found = finder(all);
  const BodyMotion error{{}, by_ranges ? Eigen::Matrix3d::Zero() : remembered.robot_covariance};
  if (found.accepted) found.accepted = predict_pose(*found.accepted, error);
  for (PoseEstimate& candidate : found.candidates) candidate = predict_pose(candidate, error);
  return found;
}

PoseSearchResult SightingMemory::find_near(const NearPoseFinder& finder, const SightingSet& seen,
                                           const PoseEstimate& prior) {
  RememberedSightings remembered = recall();
  PoseSearchResult found = finder(add_bearings(std::move(remembered.set), seen), prior);
  if (found.accepted) found.accepted = predict_pose(*found.accepted, {{}, remembered.robot_covariance});
  return found;
}

std::optional<PoseEstimate> SightingMemory::check(const PoseCheck& check, const SightingSet& seen,
                                                  const PoseEstimate& expected) {
  RememberedSightings remembered = recall();
  std::optional<PoseEstimate> found = check(add_bearings(std::move(remembered.set), seen), expected);
  if (found) found = predict_pose(*found, {{}, remembered.robot_covariance});
  return found;
}

SightingSet add_bearings(SightingSet remembered, const SightingSet& seen) {
  remembered.horizon = seen.horizon;
  for (SeenLandmark s : seen.sightings) {
    if (s.range) continue;
    if (s.bearing) s.bearing = wrap_angle(*s.bearing + seen.robot_from_sensor.yaw);
    remembered.sightings.push_back(s);
  }
  return remembered;
}

}  // namespace waymark::localization
