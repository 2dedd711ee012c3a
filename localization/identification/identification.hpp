// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>
#include "core/options.hpp"
#include "localization/identification/feature_distance.hpp"
#include "localization/identification/joint_evidence.hpp"
#include "localization/identification/landmark_grid.hpp"
namespace waymark {

struct IdentificationOptions {
  /// `mahalanobis`: v' S^-1 v + ln|S| with the covariances of pose, sensor and landmark, features over their
  /// variances. `paper`: eq. 11 literally, differences over the sensor's standard deviations.
  std::string distance = "mahalanobis";
  /// `nearest` (eq. 10, each sighting for itself), `greedy` and `hungarian` (one sighting per landmark),
  /// `jcbb` (Neira & Tardos 2001) or `joint`: probabilities of all joint hypotheses, doubtful ones rejected.
  std::string association = "joint";
  double gate = 0.99;               ///< probability that a right pairing passes
  double certainty = 0.6;           ///< `joint`: least probability of a pairing that is kept
  double ambiguity = 0;             ///< others: least lead in squared distance over the next landmark
  double feature_tolerance = 0.15;  ///< relative standard deviation two sensors may disagree by
  double feature_limit = 9;         ///< squared standard deviations a single feature may differ
  double clutter = 0.003;           ///< density of false sightings, per metre of range and radian of bearing
  double bearing_reach = 100;       ///< m: how far a sighting without range may be
  std::int64_t node_limit = 20000;  ///< of a joint search; beyond it `hungarian` decides
  bool use_identities = true;       ///< believe landmarks that say who they are
  /// A landmark of quality q has its noise divided by max(q, quality_floor) (section 4.3); 1: quality is not
  /// used.
  double quality_floor = 0.1;

  void describe(OptionVisitor& option);
};

/// Why a sighting has a landmark or none.
enum class Verdict {
  matched,
  unsound,          ///< not a number, no range, a standard deviation of 0
  unknown_type,     ///< the map has no landmark of its type, or no such identity
  nothing_near,     ///< no landmark where it could be
  features_differ,  ///< there are, but their features are others
  too_far,          ///< outside the gate
  ambiguous,        ///< two or more landmarks could be it
  taken             ///< its landmark belongs to another sighting
};
inline constexpr int kVerdicts = 8;
std::string_view wording(Verdict verdict);

/// A sighting and a landmark that could be it.
struct CandidatePair {
  std::uint32_t landmark = 0;  ///< index into the grid
  double squares = 0;          ///< squared distance; chi-square under `mahalanobis`, eq. 11 under `paper`
  double score = 0;            ///< what is minimised: squares + ln|S| under `mahalanobis`
  double features = 0;         ///< the features' part of `squares`; a missing one counts 1, its mean
  double feature_count = 0;    ///< features of the sighting that were compared or missed
  JointEvidence evidence;      ///< without features
};

/// All pairings of one sighting inside the gate, best first.
struct Candidates {
  Verdict verdict = Verdict::matched;  ///< why there is none
  std::vector<CandidatePair> pairings;
};

/// ident(d) of eq. 9: for each sighting its landmark, or why it has none.
struct Match {
  Verdict verdict = Verdict::nothing_near;
  CandidatePair pairing;   ///< of no meaning unless matched
  LandmarkKey key = 0;     ///< of the landmark; 0 unless matched
  double probability = 1;  ///< of the pairing, given that the map is right; only `joint` computes it
};

struct Identification {
  std::vector<Match> matches;  ///< one per sighting, in their order
  /// `joint` only: the pose after a Kalman update by every hypothesis, mixed by their probabilities and
  /// collapsed to one Gaussian (coupled PDA, Blom & Bloem 2000). Sightings too doubtful to be called matched
  /// still count, by as much as they can be trusted.
  std::optional<PoseEstimate> posterior;
};

/// How far a landmark is trusted: its quality, but no less than the floor; all alike where that is 1.
inline double trust_in(const MapLandmark& landmark, const IdentificationOptions& options) {
  return options.quality_floor < 1 ? std::max(landmark.quality, options.quality_floor) : 1;
}

/// Candidates by type, place and features (section 4.1, first step). Landmarks within the gate of the pose's
/// and the sensor's uncertainty; for sightings without range, of the wedge of figure 2.
Candidates candidates(const SeenLandmark& seen, const Pose2& robot_from_sensor, const PoseEstimate& robot,
                      const LandmarkGrid& map, const FeatureScales& scales,
                      const IdentificationOptions& options);

/// Second step: the best landmark for each sighting of a set.
Identification identify(const SightingSet& seen, const PoseEstimate& robot, const LandmarkGrid& map,
                        const FeatureScales& scales, const IdentificationOptions& options);

}  // namespace waymark
