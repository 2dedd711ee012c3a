// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>
#include "core/options.hpp"
#include "localization/filters/multi_hypothesis_filter.hpp"
#include "localization/identification/identification.hpp"
#include "localization/identification/landmark_grid.hpp"
#include "localization/identification/landmark_matcher.hpp"
#include "localization/line_of_sight.hpp"
#include "localization/localizer.hpp"
#include "localization/slam/bearing_starts.hpp"
#include "localization/slam/slam_relocalization.hpp"
#include "localization/slam/slam_state.hpp"
namespace waymark::localization {

/// Options of EKF SLAM.
struct SlamOptions {
  double match = 9.21;    ///< gate: squared Mahalanobis distance up to which a sighting matches
  double fresh = 25;      ///< distance beyond which it is a new landmark; between the two it is ambiguous
  double nearest = 2;     ///< m: smallest distance of a new landmark to another
  double max_range = 40;  ///< m; sightings farther away are not used
  double seen = 0.85;     ///< log odds that a match adds to a landmark's existence
  double unseen = -0.5;   ///< log odds, at most, that a missed detection adds
  double confirmed = 2;   ///< log odds from which a landmark is written to a map
  double dropped = -1;    ///< log odds below which it is removed
  double field_of_view = 1.4;            ///< rad to each side where sightings are expected
  double margin = 15;                    ///< m driven between two updates of the landmarks out of sight
  double feature_tolerance = 0.15;       ///< relative standard deviation between two sightings
  double feature_limit = 9;              ///< squared standard deviations by which a feature may differ
  IdentificationOptions identification;  ///< its quality floor and use of identities; described by its owner

  void describe(OptionVisitor& option);
};

/// A landmark of the SLAM filter.
struct SlamLandmark {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  double log_odds = 0;  ///< of its existence: the evidence counter of section 4.4
  std::int64_t matches = 0;
  std::int64_t expected = 0;       ///< sets of sightings that should have shown it, matched ones included
  std::optional<LandmarkKey> key;  ///< of the map's landmark, or of the identity it was seen with
  bool gone = false;               ///< removed because the evidence says it does not exist
  bool was_mapped = false;         ///< it was in the initial map
  std::optional<TypeId> type;
  double quality = 1;        ///< of the map's landmark: probability that it exists
  double noise_divisor = 1;  ///< of the noise of its sightings (section 4.3); 1 unless `quality=paper`
  KnownFeatures features;    ///< the signature
  std::vector<KnownFeatures>
      feature_samples;                  ///< features of each match, for the map's statistics; at most 100
  std::size_t index = 0;                ///< constant while the filter lives
  std::optional<SlamState::Slot> slot;  ///< absent: known from the map and not seen yet
};

/// EKF SLAM (section 4.4; Smith, Self & Cheeseman 1990) on the compressed filter SlamState. 0.2 ms per scan
/// of 8 stems among 100 landmarks in reach.
/// - Starts with or without a map. Landmarks of the map enter the state with their covariance when they are
///   first seen; their existence starts from their quality.
/// - Sightings without identities are associated one to one, least distance first, features included. A
///   band of ambiguity prevents duplicates. The pairs of a set must agree with each other (joint
///   compatibility, Neira & Tardos 2001): each may pass its gate by an error of the pose that others exclude.
/// - Bearings without a range start a landmark once they have been seen from two sides (BearingStarts).
/// - Ranges without a bearing correct by known landmarks and start none.
/// - A pair with a landmark of the map must also be certain (0.9) among all others and an object that the
///   map lacks (LandmarkMatcher): after a gap several landmarks are inside the gate. Where it is not, a sum
///   of Gaussians that keeps several associations (MultiHypothesisFilter on the map alone) may decide it.
class EkfSlam final : public Localizer {
 public:
  explicit EkfSlam(const PoseEstimate& start, SlamOptions options = {});
  EkfSlam(const PoseEstimate& start, LandmarkGrid map, FeatureScales scales, SlamOptions options = {},
          LineOfSight visible = {});
  void predict(const BodyMotion& motion) override;
  std::vector<Match> update(const SightingSet& seen) override;
  LocalizationStatus status() const override;

  /// Enables relocalization (SlamRelocalization). A pose that the finder proposes, or the sum of Gaussians if
  /// it disagrees, is a rival, which a second filter follows; the filter restarts there if the rival explains
  /// the further sightings better. It restarts without a trial at the sum of Gaussians where that has less
  /// than half of its deviation. It then takes landmarks of the map from the map, and keeps new ones from
  /// before it was lost.
  void set_pose_finder(PoseFinder finder, PoseCheck check = {});
  int restarts() const { return restarts_; }
  /// Returns the estimate of the sum of Gaussians while this one has a standard deviation above a metre: it
  /// then has followed one of several associations.
  PoseEstimate estimate() const override;

  /// Brings the state up to date and returns the landmarks. Includes those of the map that were not seen or
  /// are gone; omits removed ones that were in no map.
  std::vector<SlamLandmark> landmarks();
  /// Returns the map's landmark of an index; null if it is in no map.
  const MapLandmark* prior(std::size_t index) const { return index < map_.size() ? &map_[index] : nullptr; }
  /// Returns the landmark index of each sighting of the last set, new ones included; `std::nullopt` for
  /// unused sightings.
  const std::vector<std::optional<std::size_t>>& last() const { return last_; }
  /// Returns the number of ranges without bearing that showed no known landmark. They start none.
  std::size_t unplaced_ranges() const { return unplaced_ranges_; }
  /// Returns the detection probability of a landmark that exists and is in view.
  double detection() const { return (1 + hits_) / (2 + chances_); }

 private:
  struct Pair {
    double squares;
    std::size_t sighting, landmark;
  };
  struct Near {
    std::size_t landmark;
    bool expected;
  };
  static constexpr double kPrecise = 1;  // m, standard deviation of a position
  static constexpr double kOutdone = 2;  // ratio of two such deviations
  static double position_sd(const PoseEstimate& e) {
    return std::sqrt(e.covariance(0, 0) + e.covariance(1, 1));
  }
  void apply_pending_motion();
  void focus();
  double reach() const;
  std::vector<Near> landmarks_in_reach(const SightingSet& seen) const;
  double feature_distance(const SeenLandmark& seen, const SlamLandmark& landmark) const;
  std::vector<std::optional<LandmarkKey>> identify_in_map(const SightingSet& seen);
  void start_tracker(const PoseEstimate& at);
  std::optional<PoseEstimate> contradiction() const;
  bool is_outdone() const;
  PoseEstimate own_estimate() const;
  SlamState::Correction correction(const SightingSet& seen, const Pair& pair);
  std::vector<Pair> jointly_compatible(const SightingSet& seen, std::vector<Pair> chosen);
  void match(const SightingSet& seen, const std::vector<Pair>& chosen);
  void add(const SeenLandmark& seen, const Pose2& mount);
  void add(const BearingStarts::Start& start, const SightingSet& seen);
  void append(SlamLandmark fresh, const SeenLandmark& seen);
  void update_existence(const std::vector<Near>& near, const std::vector<bool>& found);
  Eigen::Vector2d position(std::size_t landmark) const;
  void check_relocalization(const SightingSet& seen, const std::vector<Near>& near,
                            const std::vector<bool>& found);
  bool is_of_map(std::size_t sighting) const { return last_[sighting] && *last_[sighting] < map_.size(); }
  void compare_with_rival(const SightingSet& seen);
  void restart(const PoseEstimate& at);

  SlamOptions options_;
  SlamState state_;
  BodyMotion pending_;  ///< motion since the last sightings
  FeatureScales scales_;
  LineOfSight visible_;
  std::optional<LandmarkMatcher> matcher_;  ///< of the map as given; none if it is empty
  LandmarkGrid map_;                        ///< as given, to find landmarks that were not seen yet
  std::vector<SlamLandmark> landmarks_;     ///< those of the map first, in the order of its grid
  std::vector<std::size_t> landmark_by_slot_;
  std::vector<std::optional<std::size_t>> last_;
  std::unordered_map<LandmarkKey, std::size_t> landmark_by_key_;
  Eigen::Vector2d centre_;                                    ///< centre of the active neighbourhood
  double focused_ = std::numeric_limits<double>::infinity();  ///< m about `centre_`: all in it is active
  double reach_ = 0, view_ = 0;                               ///< largest range and bearing seen so far
  double heard_ = 0;                                          ///< m, largest range without bearing
  bool sees_bearings_ = false;                                ///< a sighting had no range
  BearingStarts starts_;
  double hits_ = 0, chances_ = 0;
  std::size_t unplaced_ranges_ = 0;
  std::optional<SlamRelocalization> search_;
  std::unique_ptr<EkfSlam> rival_;                  ///< started at the pose under trial
  std::unique_ptr<MultiHypothesisFilter> tracker_;  ///< follows the robot in the map as given
  ChanceFraction chance_;
  SetEvidence in_map_;       ///< of the last set: `fit` and `chance`
  std::size_t trusted_ = 0;  ///< number of landmarks when the map was last seen
  int restarts_ = 0;
};

}  // namespace waymark::localization
