// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/ekf_slam.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <tuple>

#include "localization/filters/measurement.hpp"
#include "localization/slam/existence.hpp"
#include "localization/slam/signature.hpp"

namespace waymark {
namespace {

constexpr double kBeyond = 10;  // m beyond the range of sightings where landmarks are still asked for

}  // namespace

void SlamOptions::describe(OptionVisitor& option) {
  option("slam_match", match,
         {.help = "Squared Mahalanobis distance up to which a sighting is a landmark", .min = 0});
  option("slam_fresh", fresh, {.help = "and beyond which it is a new one", .min = 0});
  option("slam_nearest", nearest, {.help = "Metres between two landmarks at least", .min = 0});
  option("slam_range", most_range, {.help = "Metres up to which sightings are used", .min = 0.1});
  option("slam_seen", seen, {.help = "Log odds of existence that a match adds", .min = 0});
  option("slam_unseen", unseen, {.help = "Log odds that being expected and not seen adds", .max = 0});
  option("slam_confirmed", confirmed, {.help = "Log odds from which a landmark is written into a map"});
  option("slam_dropped", dropped, {.help = "Log odds below which a landmark is forgotten"});
  option("slam_view", field_of_view,
         {.help = "Radians to each side where sightings are expected", .min = 0, .max = 3.15});
  option("slam_margin", margin,
         {.help = "Metres driven between two updates of the landmarks out of sight", .min = 0.1});
  option("slam_feature_tolerance", feature_tolerance,
         {.help = "Relative standard deviation two looks at a landmark may disagree by",
          .min = 1e-3,
          .max = 10});
  option("slam_feature_limit", feature_limit,
         {.help = "Squared standard deviations a feature of a landmark may differ", .min = 0});
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
      centre_(start.pose.at()) {
  for (const MapLandmark& known : map_.landmarks()) {
    SlamLandmark l;
    l.at = known.at;
    l.covariance = known.covariance;
    l.log_odds = log_odds(known.quality);
    l.key = known.key;
    l.of_map = true;
    l.type = known.type;
    l.quality = known.quality;
    l.features = known.features;
    of_key_.emplace(known.key, landmarks_.size());
    landmarks_.push_back(std::move(l));
  }
}

PoseEstimate EkfSlam::estimate() const {
  return moved({state_.pose(), state_.covariance()}, pending_);
}

Eigen::Vector2d EkfSlam::place(std::size_t landmark) const {
  const SlamLandmark& l = landmarks_[landmark];
  return l.slot ? state_.at(*l.slot) : l.at;
}

void EkfSlam::settle() {
  state_.move(pending_);
  pending_ = {};
  if ((state_.pose().at() - centre_).norm() < options_.margin) return;
  state_.focus(options_.most_range + kBeyond + options_.margin);
  centre_ = state_.pose().at();
}

// Active landmarks, and those of the map about here that were not seen yet.
std::vector<EkfSlam::Near> EkfSlam::in_reach(const SightingSet& seen) const {
  const Pose2 sensor = state_.pose() * seen.robot_from_sensor;
  const double reach = options_.most_range + kBeyond;
  std::vector<Near> near;
  const auto look_at = [&](std::size_t l) {
    const Eigen::Vector2d to = place(l) - sensor.at();
    const double range = to.norm();
    if (range > reach) return;
    const double bearing = wrapped(std::atan2(to.y(), to.x()) - sensor.yaw);
    // Not more is expected of a sensor than it was seen to do.
    const bool expected = range < 0.7 * std::min(options_.most_range, reach_) &&
                          std::abs(bearing) < std::min(options_.field_of_view, 0.9 * view_) &&
                          (!visible_ || visible_(sensor, place(l)));
    near.push_back({l, expected});
  };
  for (const SlamState::Slot slot : state_.active()) look_at(of_slot_[slot]);
  map_.near(sensor.at(), reach, [&](std::uint32_t i) {
    if (!landmarks_[i].slot && !landmarks_[i].gone) look_at(i);
  });
  return near;
}

/// Squared distance of the features less its mean; infinite where they exclude each other.
double EkfSlam::features_apart(const SeenLandmark& seen, const SlamLandmark& landmark) const {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  if (!seen.type || !landmark.type) return 0;
  if (*seen.type != *landmark.type) return kNever;
  const FeatureComparison c =
      compare_features(scales_, *seen.type, seen.features, landmark.features, options_.feature_tolerance);
  return c.largest > options_.feature_limit ? kNever : c.squares - c.used;
}

std::vector<Match> EkfSlam::see(const SightingSet& seen) {
  settle();
  std::vector<Match> matches(seen.sightings.size());
  last_.assign(matches.size(), std::nullopt);
  std::vector<Pair> pairs;
  std::vector<double> least(matches.size(), 1e9), closest(matches.size(), 1e9);
  std::vector<bool> differs(matches.size(), false);
  const auto named = [&](const SeenLandmark& s) { return options_.use_identities && s.identity; };
  const auto usable = [&](const SeenLandmark& s) {
    return s.sound() && s.type != kNoSuchType && (!s.range || *s.range <= options_.most_range);
  };
  for (const SeenLandmark& s : seen.sightings)
    if (usable(s) && s.range)
      reach_ = std::max(reach_, *s.range), view_ = std::max(view_, std::abs(s.bearing));
  const std::vector<Near> near = in_reach(seen);
  std::vector<bool> found(landmarks_.size(), false);
  const Eigen::Matrix3d robot = state_.covariance();
  for (const auto& [l, is_expected] : near) {
    const SlamLandmark& landmark = landmarks_[l];
    const ExpectedSighting e = expect(state_.pose(), seen.robot_from_sensor, place(l));
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
        // Who says its name is believed, unless it lies where it cannot be.
        const Eigen::Matrix2d wide = base + sensor_noise(s);
        const double squares = s.range ? v.dot(wide.inverse() * v) : v[1] * v[1] / wide(1, 1);
        least[k] = squares, closest[k] = 0;
        if (squares < options_.fresh) pairs.push_back({squares, k, l});
        continue;
      }
      if (options_.use_identities && landmark.key && !landmark.of_map) continue;
      if (std::abs(v[0]) > 10 || std::abs(v[1]) > 1) continue;
      const double features = features_apart(s, landmark);
      if (std::isinf(features)) {
        differs[k] = true;
        continue;
      }
      closest[k] = std::min(closest[k], std::hypot(v[0], v[1] * e.value[0]));
      const Eigen::Matrix2d wide = base + sensor_noise(s);
      const double squares = s.range ? v.dot(wide.inverse() * v) : v[1] * v[1] / wide(1, 1);
      least[k] = std::min(least[k], squares);
      if (squares < options_.match) pairs.push_back({squares + std::max(features, 0.0), k, l});
    }
  }
  std::ranges::sort(pairs, [](const Pair& a, const Pair& b) {
    return std::tie(a.squares, a.sighting, a.landmark) < std::tie(b.squares, b.sighting, b.landmark);
  });
  std::vector<Pair> chosen;
  for (const Pair& p : pairs) {
    if (found[p.landmark] || matches[p.sighting].verdict == Verdict::matched) continue;
    found[p.landmark] = true;
    matches[p.sighting].verdict = Verdict::matched;
    matches[p.sighting].key = landmarks_[p.landmark].key.value_or(p.landmark + 1);
    matches[p.sighting].pairing.squares = p.squares;
    last_[p.sighting] = p.landmark;
    chosen.push_back(p);
  }
  match(seen, chosen);
  count(near, found);
  for (std::size_t k = 0; k < matches.size(); ++k) {
    const SeenLandmark& s = seen.sightings[k];
    if (matches[k].verdict == Verdict::matched) continue;
    if (!s.sound())
      matches[k].verdict = Verdict::unsound;
    else if (s.type == kNoSuchType)
      matches[k].verdict = Verdict::unknown_type;
    else if (s.range && *s.range > options_.most_range)
      matches[k].verdict = Verdict::too_far;
    else if (s.range && (named(s) ? !of_key_.contains(*s.identity)
                                  : least[k] > options_.fresh && closest[k] > options_.nearest)) {
      add(s, seen.robot_from_sensor);
      last_[k] = landmarks_.size() - 1;
      matches[k].verdict = differs[k] ? Verdict::features_differ : Verdict::nothing_near;
    } else {
      matches[k].verdict = named(s) ? Verdict::too_far : Verdict::ambiguous;
    }
  }
  if (search_) look_for_place(seen, near, found);
  return matches;
}

void EkfSlam::match(const SightingSet& seen, const std::vector<Pair>& chosen) {
  std::vector<SlamState::Correction> corrections;
  for (const Pair& p : chosen) {
    SlamLandmark& l = landmarks_[p.landmark];
    const SeenLandmark& s = seen.sightings[p.sighting];
    if (!l.slot) {
      l.slot = state_.add(l.at, l.covariance);
      of_slot_.resize(*l.slot + 1);
      of_slot_[*l.slot] = p.landmark;
    }
    const ExpectedSighting e = expect(state_.pose(), seen.robot_from_sensor, state_.at(*l.slot));
    SlamState::Correction c{.slot = *l.slot,
                            .innovation = innovation(s, e.value),
                            .by_pose = e.by_pose,
                            .by_landmark = e.by_landmark,
                            .noise = sensor_noise(s) / std::max(l.quality, options_.quality_floor)};
    if (!s.range) c.by_pose.row(0).setZero(), c.by_landmark.row(0).setZero();
    corrections.push_back(c);
    l.log_odds = std::min(l.log_odds + options_.seen, kSurestLogOdds);
    ++l.matches;
    if (!l.type) l.type = s.type;
    if (s.type) {
      merge_signature(scales_, *s.type, l.features, s.features, options_.feature_tolerance);
      if (l.looks.size() < 100) l.looks.push_back(s.features);
    }
  }
  state_.update(corrections);
}

void EkfSlam::add(const SeenLandmark& seen, const Pose2& mount) {
  const Pose2 sensor = state_.pose() * mount;
  const double along = sensor.yaw + seen.bearing;
  SlamLandmark fresh;
  fresh.at = sensor.at() + *seen.range * Eigen::Vector2d(std::cos(along), std::sin(along));
  const ExpectedSighting e = expect(state_.pose(), mount, fresh.at);
  const Eigen::Matrix2d back = e.by_landmark.inverse();
  fresh.slot = state_.add(fresh.at, -back * e.by_pose, back * sensor_noise(seen) * back.transpose());
  fresh.type = seen.type;
  fresh.features = seen.features;
  fresh.matches = fresh.expected = 1;
  if (seen.type) fresh.looks.push_back(seen.features);
  if (options_.use_identities && seen.identity) {
    fresh.key = seen.identity;
    of_key_.emplace(*seen.identity, landmarks_.size());
  }
  of_slot_.resize(*fresh.slot + 1);
  of_slot_[*fresh.slot] = landmarks_.size();
  landmarks_.push_back(std::move(fresh));
}

void EkfSlam::count(const std::vector<Near>& near, const std::vector<bool>& found) {
  const double unseen = unseen_evidence(detection(), options_.unseen);
  for (const auto& [i, is_expected] : near) {
    SlamLandmark& l = landmarks_[i];
    if (found[i] || is_expected) ++l.expected;
    if (is_expected && l.log_odds >= options_.confirmed) hits_ += found[i], ++chances_;
    // What said its name was there: a misread name is rarer than a landmark not noticed.
    if (!is_expected || found[i] || (options_.use_identities && l.key && l.matches > 0)) continue;
    l.log_odds += unseen;
    if (l.log_odds >= options_.dropped) continue;
    if (l.key) of_key_.erase(*l.key);
    l.gone = true;
    if (l.slot) {
      l.at = state_.at(*l.slot);
      l.covariance = state_.covariance(*l.slot);
      state_.remove(*l.slot);
      l.slot.reset();
    }
    l.looks = {};
  }
}

std::vector<SlamLandmark> EkfSlam::landmarks() {
  state_.focus(options_.most_range + kBeyond + options_.margin);
  centre_ = state_.pose().at();
  std::vector<SlamLandmark> all;
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    if (landmarks_[i].gone && !landmarks_[i].of_map) continue;
    all.push_back(landmarks_[i]);
    all.back().index = i;
    if (!all.back().slot) continue;
    all.back().at = state_.at(*all.back().slot);
    all.back().covariance = state_.covariance(*all.back().slot);
  }
  return all;
}

}  // namespace waymark
