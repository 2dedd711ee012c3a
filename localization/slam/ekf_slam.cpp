// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/ekf_slam.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <tuple>

#include "core/covariance.hpp"
#include "localization/chi_square.hpp"
#include "localization/filters/measurement.hpp"
#include "localization/slam/existence_log_odds.hpp"
#include "localization/slam/signature.hpp"

namespace waymark::localization {
namespace {

constexpr double kRangeMargin =
    10;  // m beyond the range of sightings in which landmarks are still considered
constexpr double kJointGate = 0.999;  // probability that right pairs of a set agree
constexpr double kCertainty = 0.9;    // of a pair with a landmark of the map: it is not revised

}  // namespace

void SlamOptions::describe(OptionVisitor& option) {
  option("slam_match", match,
         {.help = "Squared Mahalanobis distance up to which a sighting matches a landmark", .min = 0});
  option("slam_new_landmark", fresh,
         {.help = "Squared Mahalanobis distance beyond which a sighting is a new landmark",
          .min = 0,
          .formerly = "slam_fresh"});
  option("slam_min_spacing", nearest,
         {.help = "Smallest distance between two landmarks, metres", .min = 0, .formerly = "slam_nearest"});
  option("slam_range", max_range, {.help = "Largest range of sightings, metres", .min = 0.1});
  option("slam_seen", seen, {.help = "Log odds of existence that a match adds", .min = 0});
  option("slam_unseen", unseen, {.help = "Log odds of existence that a missed detection adds", .max = 0});
  option("slam_confirmed", confirmed, {.help = "Log odds from which a landmark is written to a map"});
  option("slam_dropped", dropped, {.help = "Log odds below which a landmark is removed"});
  option("slam_view", field_of_view,
         {.help = "Radians to each side where sightings are expected", .min = 0, .max = 3.15});
  option("slam_margin", margin,
         {.help = "Metres driven between two updates of the landmarks out of sight", .min = 0.1});
  option("slam_feature_tolerance", feature_tolerance,
         {.help = "Relative standard deviation between two sightings of a landmark", .min = 1e-3, .max = 10});
  option("slam_feature_limit", feature_limit,
         {.help = "Squared standard deviations by which a feature may differ", .min = 0});
}

EkfSlam::EkfSlam(const PoseEstimate& start, SlamOptions options)
    : EkfSlam(start, LandmarkGrid(), FeatureScales(), options) {}

EkfSlam::EkfSlam(const PoseEstimate& start, LandmarkGrid map, FeatureScales scales, SlamOptions options,
                 LineOfSight visible)
    : options_(options),
      state_(start),
      scales_(std::move(scales)),
      visible_(std::move(visible)),
      map_(std::move(map)),
      centre_(start.pose.at()),
      starts_(options_.max_range) {
  if (!map_.empty()) {
    IdentificationOptions identification = options_.identification;
    identification.certainty = std::max(identification.certainty, kCertainty);
    matcher_.emplace(LandmarkWindow(map_), scales_, identification);
  }
  for (const MapLandmark& known : map_.landmarks()) {
    SlamLandmark l;
    l.at = known.at;
    l.covariance = known.covariance;
    l.quality = options_.identification.quality_floor < 1 ? known.quality : 1;
    l.log_odds = log_odds(l.quality);
    l.noise_divisor = noise_divisor(known, options_.identification);
    l.key = known.key;
    l.was_mapped = true;
    l.type = known.type;
    l.features = known.features;
    landmark_by_key_.emplace(known.key, landmarks_.size());
    landmarks_.push_back(std::move(l));
  }
}

void EkfSlam::predict(const BodyMotion& motion) {
  pending_ = compose(pending_, motion);
  starts_.predict(motion);
  if (search_) search_->predict(motion);
  if (rival_) rival_->predict(motion);
  if (tracker_) tracker_->predict(motion);
}

PoseEstimate EkfSlam::own_estimate() const {
  return predict_pose({state_.pose(), state_.covariance()}, pending_);
}

PoseEstimate EkfSlam::estimate() const {
  const PoseEstimate own = own_estimate();
  return tracker_ && position_sd(own) > kPrecise ? tracker_->estimate() : own;
}

Eigen::Vector2d EkfSlam::position(std::size_t landmark) const {
  const SlamLandmark& l = landmarks_[landmark];
  return l.slot ? state_.at(*l.slot) : l.at;
}

void EkfSlam::apply_pending_motion() {
  pending_.covariance = positive_part(pending_.covariance);
  state_.predict(pending_);
  pending_ = {};
  const double moved = (state_.pose().at() - centre_).norm();
  if (moved >= options_.margin || moved + reach() > focused_) focus();
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
  return std::max(seen, heard_) + kRangeMargin;
}

// Returns active landmarks, and those of the map nearby that were not seen yet.
std::vector<EkfSlam::Near> EkfSlam::landmarks_in_reach(const SightingSet& seen) const {
  const Pose2 sensor = state_.pose() * seen.robot_from_sensor;
  const double reach = this->reach();
  std::vector<Near> near;
  const auto look_at = [&](std::size_t l) {
    const Eigen::Vector2d to = position(l) - sensor.at();
    const double range = to.norm();
    if (range > reach) return;
    const double bearing = wrap_angle(std::atan2(to.y(), to.x()) - sensor.yaw);
    // Expects detections only within the range and view that the sensor has shown.
    const bool expected = range < 0.7 * std::min(options_.max_range, reach_) &&
                          std::abs(bearing) < std::min(options_.field_of_view, 0.9 * view_) &&
                          (!visible_ || visible_(sensor, position(l)));
    near.push_back({l, expected});
  };
  for (const SlamState::Slot slot : state_.active()) look_at(landmark_by_slot_[slot]);
  map_.near(sensor.at(), reach, [&](std::uint32_t i) {
    if (!landmarks_[i].slot && !landmarks_[i].gone) look_at(i);
  });
  return near;
}

/// Returns the squared distance of the features less its mean; infinite if they exclude each other.
double EkfSlam::feature_distance(const SeenLandmark& seen, const SlamLandmark& landmark) const {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  if (seen.may_be_anything() || !landmark.type) return 0;
  const KnownFeatures* const features = seen.features_as(*landmark.type);
  if (!features) return kNever;
  const FeatureComparison c =
      compare_features(scales_, *landmark.type, *features, landmark.features, options_.feature_tolerance);
  return c.largest > options_.feature_limit ? kNever : c.squares - c.used;
}

// Returns the landmark of the map that each sighting shows with certainty.
std::vector<std::optional<LandmarkKey>> EkfSlam::identify_in_map(const SightingSet& seen) {
  std::vector<std::optional<LandmarkKey>> keys(seen.sightings.size());
  if (!matcher_) return keys;
  const auto add = [&](const std::vector<Match>& matches) {
    for (std::size_t k = 0; k < keys.size(); ++k)
      if (!keys[k] && matches[k].verdict == Verdict::matched && matches[k].probability >= kCertainty)
        keys[k] = matches[k].key;
  };
  const PoseEstimate robot{state_.pose(), state_.covariance()};
  matcher_->observe(seen);
  const LandmarkGrid& map = matcher_->landmarks_near(seen, robot);
  std::vector<Match> own = matcher_->identify(seen, robot, map).matches;
  matcher_->learn(own, seen, robot.pose, map);
  for (Match& m : own)
    if (m.verdict == Verdict::matched) m.key = map[m.pairing.landmark].key;
  add(own);
  in_map_ = {};
  if (!tracker_) {
    if (search_) in_map_.fit = matched_fraction(own);
    return keys;
  }
  const std::vector<Match> tracked = tracker_->update(seen);
  add(tracked);
  in_map_.fit = matched_fraction(tracked);
  if (in_map_.fit >= 0) in_map_.chance = chance_(seen, tracker_->estimate(), tracked);
  return keys;
}

std::vector<Match> EkfSlam::update(const SightingSet& set) {
  const auto named = [&](const SeenLandmark& s) {
    return options_.identification.use_identities && s.identity;
  };
  const auto usable = [&](const SeenLandmark& s) {
    if (!s.is_valid() || s.type == kNoSuchType) return false;
    // A beacon that identifies itself is heard farther than landmarks are seen.
    return !s.range || *s.range <= options_.max_range || (!s.bearing && named(s));
  };
  for (const SeenLandmark& s : set.sightings) {
    if (!usable(s)) continue;
    if (!s.range)
      sees_bearings_ = true;
    else if (!s.bearing)
      heard_ = std::max(heard_, *s.range);
    else
      reach_ = std::max(reach_, *s.range), view_ = std::max(view_, std::abs(*s.bearing));
  }
  apply_pending_motion();
  const std::vector<std::optional<LandmarkKey>> in_map = identify_in_map(set);
  std::vector<Match> matches(set.sightings.size());
  // Signatures of landmarks are those of a map.
  SightingSet seen = set;
  for (SeenLandmark& s : seen.sightings)
    if (s.type)
      s.features = features_in_map(scales_, *s.type, s.features,
                                   state_.pose().yaw + set.robot_from_sensor.yaw, state_.covariance()(2, 2));
  last_.assign(matches.size(), std::nullopt);
  std::vector<Pair> pairs;
  std::vector<double> lowest(matches.size(), 1e9), closest(matches.size(), 1e9);
  std::vector<bool> differs(matches.size(), false);
  const std::vector<Near> near = landmarks_in_reach(seen);
  std::vector<bool> found(landmarks_.size(), false);
  const Eigen::Matrix3d robot = state_.covariance();
  for (const auto& [l, is_expected] : near) {
    const SlamLandmark& landmark = landmarks_[l];
    const ExpectedSighting e = expect(state_.pose(), seen.robot_from_sensor, position(l));
    Eigen::Matrix2d base = e.by_pose * robot * e.by_pose.transpose();
    if (landmark.slot) {
      const Eigen::Matrix2d both = e.by_landmark * state_.cross(*landmark.slot) * e.by_pose.transpose();
      base += both + both.transpose();
    }
    base += e.by_landmark * (landmark.slot ? state_.covariance(*landmark.slot) : landmark.covariance) *
            e.by_landmark.transpose();
    for (std::size_t k = 0; k < matches.size(); ++k) {
      const SeenLandmark& s = seen.sightings[k];
      if (!usable(s)) continue;
      const Eigen::Vector2d v = innovation(s, e.value);
      if (named(s)) {
        if (landmark.key != s.identity) continue;
        // An identity is accepted unless the landmark lies where it cannot be.
        const Eigen::Matrix2d wide = base + sensor_noise(s);
        const double squares = squared_distance(s, v, wide);
        lowest[k] = squares, closest[k] = 0;
        if (squares < options_.fresh) pairs.push_back({squares, k, l});
        continue;
      }
      if (options_.identification.use_identities && landmark.key && !landmark.was_mapped) continue;
      if (!s.bearing && !landmark.was_mapped) continue;  // many landmarks may lie on its circle
      if (std::abs(v[0]) > 10 || std::abs(v[1]) > 1) continue;
      const double features = feature_distance(s, landmark);
      if (std::isinf(features)) {
        differs[k] = true;
        continue;
      }
      closest[k] = std::min(closest[k], std::hypot(v[0], v[1] * e.value[0]));
      const Eigen::Matrix2d wide = base + sensor_noise(s);
      const double squares = squared_distance(s, v, wide);
      lowest[k] = std::min(lowest[k], squares);
      if (landmark.was_mapped && in_map[k] != landmark.key) continue;
      if (squares < options_.match) pairs.push_back({squares + std::max(features, 0.0), k, l});
    }
  }
  std::ranges::sort(pairs, [](const Pair& a, const Pair& b) {
    return std::tie(a.squares, a.sighting, a.landmark) < std::tie(b.squares, b.sighting, b.landmark);
  });
  std::vector<Pair> chosen;
  std::vector<bool> used(matches.size(), false);
  for (const Pair& p : pairs) {
    if (found[p.landmark] || used[p.sighting]) continue;
    found[p.landmark] = used[p.sighting] = true;
    chosen.push_back(p);
  }
  chosen = jointly_compatible(seen, std::move(chosen));
  found.assign(found.size(), false);
  for (const Pair& p : chosen) {
    found[p.landmark] = true;
    matches[p.sighting].verdict = Verdict::matched;
    matches[p.sighting].key = landmarks_[p.landmark].key.value_or(p.landmark + 1);
    matches[p.sighting].pairing.squares = p.squares;
    if (landmarks_[p.landmark].was_mapped) {
      matches[p.sighting].at = landmarks_[p.landmark].at;
      matches[p.sighting].covariance = landmarks_[p.landmark].covariance;
    }
    last_[p.sighting] = p.landmark;
  }
  match(seen, chosen);
  update_existence(near, found);
  std::vector<std::size_t> new_bearings;
  for (std::size_t k = 0; k < matches.size(); ++k) {
    const SeenLandmark& s = seen.sightings[k];
    if (matches[k].verdict == Verdict::matched) continue;
    const bool is_new = named(s) ? !landmark_by_key_.contains(*s.identity)
                                 : lowest[k] > options_.fresh && (!s.range || closest[k] > options_.nearest);
    if (!s.is_valid())
      matches[k].verdict = Verdict::unsound;
    else if (s.type == kNoSuchType)
      matches[k].verdict = Verdict::unknown_type;
    else if (!usable(s))
      matches[k].verdict = Verdict::too_far;
    else if (!s.range && is_new) {
      new_bearings.push_back(k);
      matches[k].verdict = Verdict::nothing_near;
    } else if (!s.bearing && is_new) {  // its position is not known
      ++unplaced_ranges_;
      matches[k].verdict = Verdict::nothing_near;
    } else if (is_new) {
      add(s, seen.robot_from_sensor);
      last_[k] = landmarks_.size() - 1;
      matches[k].verdict = differs[k] ? Verdict::features_differ : Verdict::nothing_near;
    } else {
      matches[k].verdict = named(s) ? Verdict::too_far : Verdict::ambiguous;
    }
  }
  for (const BearingStarts::Start& start :
       starts_.add(seen, new_bearings, options_.identification.use_identities)) {
    add(start, seen);
    last_[start.sighting] = landmarks_.size() - 1;
  }
  if (search_) check_relocalization(set, near, found);
  return matches;
}

SlamState::Correction EkfSlam::correction(const SightingSet& seen, const Pair& pair) {
  SlamLandmark& l = landmarks_[pair.landmark];
  const SeenLandmark& s = seen.sightings[pair.sighting];
  if (!l.slot) {
    l.slot = state_.add(l.at, l.covariance);
    landmark_by_slot_.resize(*l.slot + 1);
    landmark_by_slot_[*l.slot] = pair.landmark;
  }
  const ExpectedSighting e = expect(state_.pose(), seen.robot_from_sensor, state_.at(*l.slot));
  SlamState::Correction c{.slot = *l.slot,
                          .innovation = innovation(s, e.value),
                          .by_pose = e.by_pose,
                          .by_landmark = e.by_landmark,
                          .noise = sensor_noise(s) / l.noise_divisor};
  omit_missing(s, c.by_pose, c.by_landmark, c.noise);
  return c;
}

// Removes the pair without which the others agree best, until they agree.
std::vector<EkfSlam::Pair> EkfSlam::jointly_compatible(const SightingSet& seen, std::vector<Pair> chosen) {
  std::vector<SlamState::Correction> corrections;
  int rows = 0;
  for (const Pair& p : chosen) {
    corrections.push_back(correction(seen, p));
    rows += seen.sightings[p.sighting].has_position() ? 2 : 1;
  }
  while (chosen.size() > 1 &&
         state_.joint_squares(corrections) > chi_square_quantile(kJointGate, static_cast<double>(rows))) {
    std::size_t worst = 0;
    double lowest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      std::vector<SlamState::Correction> rest = corrections;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(k));
      if (const double squares = state_.joint_squares(rest); squares < lowest) lowest = squares, worst = k;
    }
    rows -= seen.sightings[chosen[worst].sighting].has_position() ? 2 : 1;
    chosen.erase(chosen.begin() + static_cast<std::ptrdiff_t>(worst));
    corrections.erase(corrections.begin() + static_cast<std::ptrdiff_t>(worst));
  }
  return chosen;
}

void EkfSlam::match(const SightingSet& seen, const std::vector<Pair>& chosen) {
  std::vector<SlamState::Correction> corrections;
  for (const Pair& p : chosen) {
    const SlamState::Correction c = correction(seen, p);
    SlamLandmark& l = landmarks_[p.landmark];
    const SeenLandmark& s = seen.sightings[p.sighting];
    corrections.push_back(c);
    l.log_odds = std::min(l.log_odds + options_.seen, kSurestLogOdds);
    ++l.matches;
    if (!l.type) l.type = s.type;
    if (const KnownFeatures* const features = l.type ? s.features_as(*l.type) : nullptr) {
      merge_signature(scales_, *l.type, l.features, *features, options_.feature_tolerance);
      if (l.feature_samples.size() < 100) l.feature_samples.push_back(*features);
    }
  }
  state_.update(corrections);
}

void EkfSlam::add(const SeenLandmark& seen, const Pose2& mount) {
  const Pose2 sensor = state_.pose() * mount;
  const double along = sensor.yaw + *seen.bearing;
  SlamLandmark fresh;
  fresh.at = sensor.at() + *seen.range * Eigen::Vector2d(std::cos(along), std::sin(along));
  const ExpectedSighting e = expect(state_.pose(), mount, fresh.at);
  const Eigen::Matrix2d back = e.by_landmark.inverse();
  fresh.slot = state_.add(fresh.at, -back * e.by_pose, back * sensor_noise(seen) * back.transpose());
  append(std::move(fresh), seen);
}

void EkfSlam::add(const BearingStarts::Start& start, const SightingSet& seen) {
  const Pose2& robot = state_.pose();
  SlamLandmark fresh;
  fresh.at = (robot * Pose2{start.at.x(), start.at.y(), 0}).at();
  const Eigen::Vector2d to = fresh.at - robot.at();
  Eigen::Matrix<double, 2, 3> by_pose;
  by_pose << 1, 0, -to.y(), 0, 1, to.x();
  Eigen::Matrix2d turn;
  turn << std::cos(robot.yaw), -std::sin(robot.yaw), std::sin(robot.yaw), std::cos(robot.yaw);
  fresh.slot = state_.add(fresh.at, by_pose, turn * start.covariance * turn.transpose());
  append(std::move(fresh), seen.sightings[start.sighting]);
}

void EkfSlam::append(SlamLandmark fresh, const SeenLandmark& seen) {
  fresh.type = seen.type;
  fresh.features = seen.features;
  fresh.matches = fresh.expected = 1;
  if (seen.type) fresh.feature_samples.push_back(seen.features);
  if (options_.identification.use_identities && seen.identity) {
    fresh.key = seen.identity;
    landmark_by_key_.emplace(*seen.identity, landmarks_.size());
  }
  landmark_by_slot_.resize(*fresh.slot + 1);
  landmark_by_slot_[*fresh.slot] = landmarks_.size();
  landmarks_.push_back(std::move(fresh));
}

void EkfSlam::update_existence(const std::vector<Near>& near, const std::vector<bool>& found) {
  const double unseen = unseen_evidence(detection(), options_.unseen);
  for (const auto& [i, is_expected] : near) {
    SlamLandmark& l = landmarks_[i];
    if (found[i] || is_expected) ++l.expected;
    if (is_expected && l.log_odds >= options_.confirmed) hits_ += found[i], ++chances_;
    // A landmark with an identity exists: a misread identity is rarer than a missed detection.
    if (!is_expected || found[i] || (options_.identification.use_identities && l.key && l.matches > 0))
      continue;
    l.log_odds += unseen;
    if (l.log_odds >= options_.dropped) continue;
    if (l.key) landmark_by_key_.erase(*l.key);
    l.gone = true;
    if (l.slot) {
      l.at = state_.at(*l.slot);
      l.covariance = state_.covariance(*l.slot);
      state_.remove(*l.slot);
      l.slot.reset();
    }
    l.feature_samples = {};
  }
}

std::vector<SlamLandmark> EkfSlam::landmarks() {
  focus();
  std::vector<SlamLandmark> all;
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    if (landmarks_[i].gone && !landmarks_[i].was_mapped) continue;
    all.push_back(landmarks_[i]);
    all.back().index = i;
    if (!all.back().slot) continue;
    all.back().at = state_.at(*all.back().slot);
    all.back().covariance = state_.covariance(*all.back().slot);
  }
  return all;
}

}  // namespace waymark::localization
