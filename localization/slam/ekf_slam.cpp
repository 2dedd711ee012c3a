// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/ekf_slam.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "core/covariance.hpp"
#include "localization/line_of_sight.hpp"
#include "localization/slam/existence_log_odds.hpp"
#include "localization/slam/signature.hpp"

namespace waymark::localization {
namespace {

constexpr double kCertainty = 0.9;  // of a pair with a landmark of the map: it is not revised
constexpr double kStands = 4;  // log odds, at most, that an object of a map still stands before it is seen

}  // namespace

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
      starts_(options_.max_range),
      missed_(map_.landmarks().size()) {
  if (!map_.empty()) {
    IdentificationOptions identification = options_.identification;
    identification.certainty = std::max(identification.certainty, kCertainty);
    identification.leave_out_outweighed = false;
    matcher_.emplace(LandmarkWindow(map_), scales_, identification);
  }
  for (const MapLandmark& known : map_.landmarks()) {
    SlamLandmark l;
    l.quality = options_.identification.quality_floor < 1 ? known.quality : 1;
    l.log_odds = log_odds(l.quality);
    l.noise_divisor = noise_divisor(known, options_.identification);
    l.key = known.key;
    l.was_mapped = true;
    l.type = known.type;
    l.features = known.features;
    set_as_mapped(l, known);
    landmark_by_key_.emplace(known.key, landmarks_.size());
    landmarks_.push_back(std::move(l));
  }
}

void EkfSlam::predict(const BodyMotion& motion) {
  pending_ = compose(pending_, motion);
  starts_.predict(motion);
  if (search_) search_->predict(motion), past_.predict(motion);
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
  return l.line ? l.line->anchor : l.slot ? state_.at(*l.slot) : l.at;
}

void EkfSlam::apply_pending_motion() {
  pending_.covariance = positive_part(pending_.covariance);
  state_.predict(pending_);
  pending_ = {};
  const double moved = (state_.pose().at() - centre_).norm();
  if (moved >= options_.margin || moved + reach() > focused_) focus();
}

template <class Fix>
bool EkfSlam::apply_fix(const Fix& measured, int rows) {
  apply_pending_motion();
  if (rival_) rival_->fix(measured);
  if (tracker_) tracker_->fix(measured);
  const auto squares = [&] {
    return update_pose(PoseEstimate{state_.pose(), state_.covariance()}, measured).squares;
  };
  FixGate& gate = rows == 2 ? gnss_ : heading_;
  if (!gate.pass(squares(), rows)) return false;
  for (int i = 0; gate.was_forced() && i < 40 && squares() > 4; ++i)
    state_.predict({{}, state_.covariance().diagonal().asDiagonal()});
  state_.update(innovation(state_.pose(), measured));
  return true;
}
template bool EkfSlam::apply_fix(const GnssFix&, int);
template bool EkfSlam::apply_fix(const HeadingFix&, int);

// Returns the landmark of the map that each sighting shows with certainty.
std::vector<std::optional<LandmarkKey>> EkfSlam::identify_in_map(const SightingSet& seen) {
  std::vector<std::optional<LandmarkKey>> keys(seen.sightings.size());
  if (!matcher_) return keys;
  const auto add = [&](const std::vector<Match>& matches) {
    for (std::size_t k = 0; k < keys.size(); ++k)
      if (!keys[k] && matches[k].verdict == Verdict::matched &&
          certainty_of(seen.sightings[k], matches[k].probability, matches[k].unmapped) >= kCertainty)
        keys[k] = matches[k].key;
  };
  const PoseEstimate robot{state_.pose(), state_.covariance()};
  matcher_->observe(seen);
  const LandmarkGrid& map = matcher_->landmarks_near(seen, robot);
  std::vector<Match> own = matcher_->identify(seen, robot, map).matches;
  matcher_->learn(own, seen, robot, map);
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

// Returns the sightings with directions turned into the map: signatures of landmarks are those of a map.
// Those of lines stay: they are measurements.
SightingSet EkfSlam::with_features_in_map(SightingSet seen) const {
  for (SeenLandmark& s : seen.sightings)
    if (s.type && !s.extent)
      s.features = features_in_map(scales_, *s.type, s.features,
                                   state_.pose().yaw + seen.robot_from_sensor.yaw, state_.covariance()(2, 2));
  return seen;
}

std::vector<Match> EkfSlam::update(const SightingSet& set) {
  ++sets_;
  note_reach(set);
  apply_pending_motion();
  const std::vector<std::optional<LandmarkKey>> in_map = identify_in_map(set);
  const SightingSet seen = with_features_in_map(set);
  const std::vector<SlamCandidate> near = landmarks_in_reach(seen);
  SlamPairs found = compare_with_landmarks(seen.sightings, near, landmarks_, in_map, scales_, options_);
  std::vector<Match> matches(seen.sightings.size());
  last_.assign(matches.size(), std::nullopt);
  match(seen, pair_one_to_one(std::move(found.pairs)), matches);
  std::vector<bool> is_found(landmarks_.size(), false);
  for (const std::optional<std::size_t>& landmark : last_)
    if (landmark) is_found[*landmark] = true;
  update_existence(seen, near, is_found);
  add_new(seen, found.comparisons, matches);
  if (search_) check_relocalization(set, near, is_found);
  return matches;
}

SlamState::Correction EkfSlam::correction(const SightingSet& seen, const SlamPair& pair) {
  SlamLandmark& l = landmarks_[pair.landmark];
  const SeenLandmark& s = seen.sightings[pair.sighting];
  if (!l.slot) {
    l.slot = state_.add(l.at, l.covariance);
    landmark_by_slot_.resize(*l.slot + 1);
    landmark_by_slot_[*l.slot] = pair.landmark;
    if (l.line) set_site(l);
  }
  if (l.line) return line_correction(pair.landmark, s, seen.robot_from_sensor);
  const ExpectedSighting e = expect(state_.pose(), seen.robot_from_sensor, state_.at(*l.slot));
  SlamState::Correction c{.slot = *l.slot,
                          .innovation = innovation(s, e.value),
                          .by_pose = e.by_pose,
                          .by_landmark = e.by_landmark,
                          .noise = sensor_noise(s) / l.noise_divisor};
  omit_missing(s, c.by_pose, c.by_landmark, c.noise);
  return c;
}

// Corrects the state by the pairs that agree with each other.
void EkfSlam::match(const SightingSet& seen, std::vector<SlamPair> pairs, std::vector<Match>& matches) {
  std::vector<SlamState::Correction> corrections;
  for (const SlamPair& p : pairs) corrections.push_back(correction(seen, p));
  remove_incompatible(state_, seen.sightings, pairs, corrections);
  for (const SlamPair& p : pairs) {
    SlamLandmark& l = landmarks_[p.landmark];
    const SeenLandmark& s = seen.sightings[p.sighting];
    last_[p.sighting] = p.landmark;
    Match& m = matches[p.sighting];
    m.verdict = Verdict::matched;
    m.key = l.key.value_or(p.landmark + 1);
    m.pairing.squares = p.squares;
    if (l.was_mapped && l.line)
      m.at = map_[p.landmark].at, m.covariance = map_[p.landmark].covariance;
    else if (l.was_mapped)
      m.at = l.at, m.covariance = l.covariance;
    l.log_odds = std::min(l.log_odds - l.missed + options_.seen, kSurestLogOdds);
    l.missed = 0;
    if (l.matches++ == 0) l.first_set = sets_;
    l.last_set = sets_;
    if (l.line) {
      see_piece(l, s, state_.pose() * seen.robot_from_sensor);
      continue;
    }
    if (!l.type) l.type = s.type;
    if (const KnownFeatures* const features = l.type ? s.features_as(*l.type) : nullptr) {
      merge_signature(scales_, *l.type, l.features, *features, options_.feature_tolerance);
      if (l.feature_samples.size() < 100) l.feature_samples.push_back(*features);
    }
  }
  state_.update(corrections);
}

// Starts landmarks by the sightings that show none, and gives the other unmatched ones their verdicts.
void EkfSlam::add_new(const SightingSet& seen, std::span<const SlamComparison> comparisons,
                      std::vector<Match>& matches) {
  std::vector<std::size_t> new_bearings;
  bool line_starts = false;
  for (std::size_t k = 0; k < matches.size(); ++k) {
    const SeenLandmark& s = seen.sightings[k];
    Verdict& verdict = matches[k].verdict;
    if (verdict == Verdict::matched) continue;
    const bool is_named = is_identified(s, options_) && !s.extent;
    const SlamComparison& c = comparisons[k];
    const bool is_new =
        is_named ? !landmark_by_key_.contains(*s.identity)
                 : c.min_squares > options_.fresh && (!s.range || c.min_distance > options_.nearest);
    if (!s.is_valid()) {
      verdict = Verdict::unsound;
    } else if (s.type == kNoSuchType) {
      verdict = Verdict::unknown_type;
    } else if (!is_usable(s, options_)) {
      verdict = Verdict::too_far;
    } else if (!is_new) {
      verdict = is_named ? Verdict::too_far : Verdict::ambiguous;
    } else if (s.extent && line_starts && continues_line(s, seen)) {
      verdict = Verdict::ambiguous;  // it will match the line that another piece of it started
    } else if (s.has_position() || s.extent) {
      line_starts = line_starts || s.extent;
      s.extent ? add_line(s, seen.robot_from_sensor) : add(s, seen.robot_from_sensor);
      last_[k] = landmarks_.size() - 1;
      verdict = c.features_differ ? Verdict::features_differ : Verdict::nothing_near;
    } else {  // its position is not known yet
      verdict = Verdict::nothing_near;
      if (s.range)
        ++unplaced_ranges_;
      else
        new_bearings.push_back(k);
    }
  }
  for (const BearingStarts::Start& start :
       starts_.add(seen, new_bearings, options_.identification.use_identities)) {
    add(start, seen);
    last_[start.sighting] = landmarks_.size() - 1;
  }
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
  fresh.first_set = fresh.last_set = sets_;
  if (seen.type) fresh.feature_samples.push_back(seen.features);
  if (options_.identification.use_identities && seen.identity) {
    fresh.key = seen.identity;
    landmark_by_key_.emplace(*seen.identity, landmarks_.size());
  }
  landmark_by_slot_.resize(*fresh.slot + 1);
  landmark_by_slot_[*fresh.slot] = landmarks_.size();
  landmarks_.push_back(std::move(fresh));
}

MissedViews::Look EkfSlam::look_at(const SightingSet& seen, const SlamCandidate& candidate,
                                   bool found) const {
  return {.landmark = candidate.landmark,
          .source = seen.ranges ? 1 : 0,
          .type = landmarks_[candidate.landmark].type,
          .sensor = (state_.pose() * seen.robot_from_sensor).at(),
          .range = candidate.sighting.value[0],
          .is_seen = found};
}

void EkfSlam::update_existence(const SightingSet& seen, std::span<const SlamCandidate> near,
                               const std::vector<bool>& found) {
  const double unseen = unseen_evidence(detection(), options_.unseen);
  for (const SlamCandidate& candidate : near) {
    const std::size_t i = candidate.landmark;
    const bool is_expected = candidate.is_expected;
    SlamLandmark& l = landmarks_[i];
    const bool by_views = l.was_mapped && !l.line;
    const bool counts = by_views ? candidate.is_in_view : is_expected;
    if (found[i] || counts) ++l.expected;
    if (is_expected && l.log_odds >= options_.confirmed && (!l.was_mapped || l.matches > 0))
      hits_ += found[i], ++chances_;
    if (by_views && found[i]) missed_.note_match(i);
    if (by_views && counts) missed_.add(look_at(seen, candidate, found[i]));
    // A landmark with an identity exists: a misread identity is rarer than a missed detection.
    if (!counts || found[i] || (options_.identification.use_identities && l.key && l.matches > 0)) continue;
    if (by_views)
      revise_by_views(l, missed_.evidence(i));
    else
      l.log_odds += unseen;
    if (l.log_odds < options_.dropped) remove(l);
  }
}

void EkfSlam::revise_by_views(SlamLandmark& l, double evidence) const {
  if (l.missed == 0 && evidence < 0 && l.matches == 0) l.log_odds = std::min(l.log_odds, kStands);
  l.log_odds += evidence - l.missed;
  l.missed = evidence;
}

void EkfSlam::remove(SlamLandmark& l) {
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

std::vector<SlamLandmark> EkfSlam::landmark_states() {
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

std::vector<SlamLandmark> EkfSlam::landmarks() {
  std::vector<SlamLandmark> all = landmark_states();
  for (SlamLandmark& l : all)
    if (l.line) state_as_position(l);
  return all;
}

}  // namespace waymark::localization
