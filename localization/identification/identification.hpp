// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>
#include "core/options.hpp"
#include "localization/identification/feature_distance.hpp"
#include "localization/identification/joint_evidence.hpp"
#include "localization/identification/landmark_grid.hpp"
#include "localization/line_of_sight.hpp"
namespace waymark::localization {

/// Options of data association.
struct IdentificationOptions {
  /// `mahalanobis`: v' S^-1 v + ln|S| with the covariances of pose, sensor and landmark, features over their
  /// variances. `paper`: eqs. 9-11 literally, differences over the sensor's standard deviations.
  std::string distance = "mahalanobis";
  /// `auto` is `joint`, with `distance=paper` `nearest`. `nearest` (eq. 10, each sighting alone), `greedy`
  /// and `hungarian` (one sighting per landmark), `jcbb` (Neira & Tardos 2001) or `joint`: probabilities of
  /// all joint hypotheses, with ambiguous pairings rejected. The last two decide by their own evidence and
  /// exclude `distance=paper`.
  std::string association = "auto";
  double gate = 0.99;               ///< probability that a right pairing passes
  double certainty = 0.6;           ///< `joint`: smallest probability of an accepted pairing
  double bearing_certainty = 0.95;  ///< the same for a sighting without range or without bearing
  double ambiguity = 0;             ///< others: smallest lead in squared distance over the next landmark
  double feature_tolerance = 0.15;  ///< relative standard deviation between two sensors
  double feature_limit = 9;         ///< squared standard deviations by which one feature may differ
  /// `distance=paper` and `weights=paper`: alpha_f of eq. 11, as "rock.radius=4,rock.height=2". Others follow
  /// from the declaration of the type (FeatureScales::alpha).
  std::string alpha = {};
  /// Density of sightings that show no landmark of the map, per metre of range and radian of bearing. With
  /// `learn_clutter` the least one: filters estimate it over the drive.
  double clutter = 0.003;
  bool learn_clutter = true;
  double bearing_reach = 0;  ///< m: largest range of a sighting without range; 0: that of its type and sensor
  double sensor_range = 0;   ///< m: of a sensor that measures bearings alone; 0: unknown. No option
  std::int64_t node_limit = 20000;      ///< of a joint search; beyond it `hungarian` is used
  bool use_identities = true;           ///< use the identities of landmarks
  std::vector<TypeId> held_types = {};  ///< types of the map's landmarks; empty: not known. No option
  /// Landmarks that the terrain hides are no candidates, unless the log identifies them.
  bool use_terrain = false;
  LineOfSight visible = {};  ///< over the terrain, for `use_terrain`; no option
  /// `existence`: the probability that a landmark exists is the prior of its pairings. `paper`: the noise of
  /// a landmark of quality q (eq. 8) is divided by max(q, quality_floor) (section 4.3).
  std::string quality = "existence";
  double quality_floor = 0.1;  ///< 1: quality is not used
  /// Leave out landmarks that others outweigh. SLAM uses them: it decides itself what exists. No option
  bool leave_out_outweighed = true;

  /// Factor, by type, of the existence of doubtful landmarks (DoubtCalibration). No option
  std::vector<double> doubt_factors = {};

  void describe(OptionVisitor& option);
  /// Returns the association that `auto` stands for, otherwise the given one.
  std::string_view chosen_association() const;
  /// Returns the smallest probability of an accepted pairing of a sighting.
  double required_certainty(const SeenLandmark& seen) const {
    const bool is_locus =
        !seen.has_position() && !seen.extent && !seen.elevation && !(use_identities && seen.identity);
    return is_locus ? std::max(certainty, bearing_certainty) : certainty;
  }
  /// Returns the largest range of a sighting without range. What is seen on the horizon, such as summits, is
  /// seen beyond the range of a sensor.
  double reach_of(const SeenLandmark& seen, const FeatureScales& scales) const;
  /// Returns the density of false sightings without range, per radian: those nearer than `bearing_reach`, the
  /// range of the sensor, or 100 m. Objects confused with landmarks are near, so it does not grow with the
  /// reach of a type.
  double bearing_clutter() const { return clutter * clutter_reach(); }
  /// Returns the density of false sightings without bearing, per metre: those of a full turn.
  double range_clutter() const { return clutter * 2 * std::numbers::pi; }
  /// Returns the density of false sightings of this kind: per metre and radian, per radian or per metre.
  double clutter_of(const SeenLandmark& seen) const {
    return seen.has_position() ? clutter : seen.range ? range_clutter() : bearing_clutter();
  }
  /// Returns the metres over which the density of false sightings without range is spread.
  double clutter_reach() const;
  /// Returns whether the map may have a landmark of the sighting's type.
  bool may_be_mapped(const SeenLandmark& seen) const;
  /// Returns whether the association uses `distance`: not `paper` with one that has its own evidence.
  bool distance_applies() const;
};

/// Result of the data association of a sighting.
enum class Verdict {
  matched,
  unsound,          ///< not a number, neither range nor bearing, a standard deviation of 0
  unknown_type,     ///< the map has no landmark of its type, or no such identity
  nothing_near,     ///< no landmark within reach
  features_differ,  ///< landmarks within reach have other features
  too_far,          ///< outside the gate
  ambiguous,        ///< two or more landmarks could be it
  taken             ///< its landmark is matched with another sighting
};
/// Number of verdicts.
inline constexpr int kVerdicts = 8;
/// Returns a verdict in words.
std::string_view wording(Verdict verdict);
/// Returns the name of a verdict as above: "nothing_near".
std::string_view verdict_name(Verdict verdict);

/// A sighting and a landmark that may match.
struct CandidatePair {
  std::uint32_t landmark = 0;  ///< index into the grid
  double squares = 0;          ///< squared distance; chi-square under `mahalanobis`, eq. 11 under `paper`
  double score = 0;            ///< minimised cost: squares + ln|S| under `mahalanobis`
  double features = 0;         ///< part of `squares` from features; a missing one counts 1, its mean
  double feature_count = 0;    ///< features of the sighting that were compared or are missing
  JointEvidence evidence;      ///< without features
};

/// All pairings of one sighting inside the gate, best first.
struct Candidates {
  Verdict verdict = Verdict::matched;  ///< why there are none
  std::vector<CandidatePair> pairings;
};

/// ident(d) of eq. 9: the landmark of a sighting, or why it has none.
struct Match {
  Verdict verdict = Verdict::nothing_near;
  CandidatePair pairing;                         ///< only valid if matched
  LandmarkKey key = 0;                           ///< of the landmark; 0 unless matched
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< its position on the map, unless the method moved it
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of `at`; 0 unless matched with the map
  double probability = 1;  ///< of the pairing, if the map is right; only from `joint`
  /// Probability that the sighting shows no landmark of the map; 0 or 1 by the verdict but for `joint`.
  double unmapped = 1;
};

/// Returns the probability that decides whether a pairing is certain: its own, but of a line that of any
/// pairing, since pieces of one wall measure the same.
inline double certainty_of(const SeenLandmark& seen, double pairing, double unmapped) {
  return seen.extent ? 1 - unmapped : pairing;
}

/// Sets the key, the position and its covariance of the landmark that was matched.
inline void name_landmark(Match& match, const MapLandmark& landmark) {
  match.key = landmark.key, match.at = landmark.at, match.covariance = landmark.covariance;
}

/// Data association of a set of sightings.
struct Identification {
  std::vector<Match> matches;  ///< one per sighting, in their order
  /// `joint` only: the pose after a Kalman update by every hypothesis, mixed by their probabilities and
  /// collapsed to one Gaussian (coupled PDA, Blom & Bloem 2000). Ambiguous sightings contribute by their
  /// probability.
  std::optional<PoseEstimate> posterior;
};

/// Returns the divisor of a landmark's noise: its quality (eq. 8), at least the floor; 1 unless
/// `quality=paper`.
inline double noise_divisor(const MapLandmark& landmark, const IdentificationOptions& options) {
  return options.quality == "paper" ? std::max(landmark.paper_quality, options.quality_floor) : 1;
}

/// Returns the factor by which a drive corrected the existence of a doubtful landmark; 1 for others.
inline double doubt_factor(const MapLandmark& landmark, const IdentificationOptions& options) {
  const bool is_corrected = landmark.type < options.doubt_factors.size() && landmark.is_doubtful();
  return is_corrected ? options.doubt_factors[landmark.type] : 1;
}

/// Doubtful landmarks with a smaller factor are left out: a drive saw less than a quarter of those expected.
inline constexpr double kMinDoubtFactor = 0.25;

/// Returns the prior probability of a landmark's pairings: that it exists, of a doubtful one times the factor
/// that the drive taught; 1 unless `quality=existence`.
inline double existence_prior(const MapLandmark& landmark, const IdentificationOptions& options) {
  return options.quality == "existence" && options.quality_floor < 1
             ? landmark.quality * doubt_factor(landmark, options)
             : 1;
}

/// Returns whether a landmark is no candidate of sightings without identity, as others nearby outweigh it or
/// a drive showed that few such landmarks exist; false unless `quality=existence` and with `distance=paper`.
/// Beside true landmarks a doubtful one is taken for an unmapped object more often than it is seen.
inline bool is_left_out(const MapLandmark& landmark, const IdentificationOptions& options) {
  const bool is_unlikely = landmark.outweighed || doubt_factor(landmark, options) < kMinDoubtFactor;
  return is_unlikely && options.leave_out_outweighed && options.distance != "paper" &&
         options.quality == "existence" && options.quality_floor < 1;
}

/// Returns the headings of the robot that the angles of a sighting measure if it shows a landmark.
std::vector<AngleFix> headings_from_angles(const SeenLandmark& seen, const Pose2& robot_from_sensor,
                                           const MapLandmark& landmark, double robot_yaw,
                                           const FeatureScales& scales, const IdentificationOptions& options);

/// Returns the candidates by type, position and features (section 4.1, first step): landmarks within the
/// gate of the pose's and the sensor's uncertainty. For sightings without range, those in the wedge of
/// figure 2.
Candidates candidates(const SeenLandmark& seen, const Pose2& robot_from_sensor, const PoseEstimate& robot,
                      const LandmarkGrid& map, const FeatureScales& scales,
                      const IdentificationOptions& options);

/// Matches the sightings of a set with landmarks (section 4.1, second step). Throws std::invalid_argument
/// unless `distance_applies`.
Identification identify(const SightingSet& seen, const PoseEstimate& robot, const LandmarkGrid& map,
                        const FeatureScales& scales, const IdentificationOptions& options);

}  // namespace waymark::localization
