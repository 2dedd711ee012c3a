// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>
#include "localization/filters/multi_hypothesis_filter.hpp"
#include "localization/identification/landmark_grid.hpp"
#include "localization/identification/landmark_matcher.hpp"
#include "localization/line_of_sight.hpp"
#include "localization/localizer.hpp"
#include "localization/slam/bearing_starts.hpp"
#include "localization/slam/missed_views.hpp"
#include "localization/slam/past_sets.hpp"
#include "localization/slam/slam_association.hpp"
#include "localization/slam/slam_landmark.hpp"
#include "localization/slam/slam_options.hpp"
#include "localization/slam/slam_relocalization.hpp"
#include "localization/slam/slam_state.hpp"
namespace waymark::localization {

/// EKF SLAM (section 4.4; Smith, Self & Cheeseman 1990) on the compressed filter SlamState. 0.2 ms per scan
/// of 8 stems among 100 landmarks in reach.
/// - Starts with or without a map. Landmarks of the map enter the state with their covariance when they are
///   first seen; their existence starts from their quality.
/// - Sightings without identities are associated one to one, least distance first, features included. A
///   band of ambiguity prevents duplicates. The pairs of a set must agree with each other (joint
///   compatibility, Neira & Tardos 2001): each may pass its gate by an error of the pose that others exclude.
/// - Bearings without a range start a landmark once they have been seen from two sides (BearingStarts).
/// - Lines, such as walls, have two numbers as well: distance and direction of the normal (SlamLine). Pieces
///   of one line with gaps of 1.5 m or less are one landmark. Sightings add to its existence, nothing
///   subtracts.
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
  /// Updates pose and landmarks by a fix. After ten rejections in a row the deviation of the pose grows until
  /// the fix is within two standard deviations.
  bool fix(const GnssFix& gnss) override { return apply_fix(gnss, 2); }
  bool fix(const HeadingFix& heading) override { return apply_fix(heading, 1); }
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
  /// Returns the same, but lines with their two numbers in place of a position.
  std::vector<SlamLandmark> landmark_states();
  /// Returns the frame of a line; null for a point.
  const SlamLine* line(std::size_t index) const {
    return landmarks_[index].line ? &*landmarks_[index].line : nullptr;
  }
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
  static constexpr double kPrecise = 1;  // m, standard deviation of a position
  static constexpr double kOutdone = 2;  // ratio of two such deviations
  static double position_sd(const PoseEstimate& e) {
    return std::sqrt(e.covariance(0, 0) + e.covariance(1, 1));
  }
  template <class Fix>
  bool apply_fix(const Fix& measured, int rows);
  void apply_pending_motion();
  void focus();
  double reach() const;
  void note_reach(const SightingSet& seen);
  SightingSet with_features_in_map(SightingSet seen) const;
  std::vector<SlamCandidate> landmarks_in_reach(const SightingSet& seen) const;
  std::vector<std::optional<LandmarkKey>> identify_in_map(const SightingSet& seen);
  void start_tracker(const PoseEstimate& at);
  std::optional<PoseEstimate> contradiction() const;
  bool is_outdone() const;
  PoseEstimate own_estimate() const;
  SlamState::Correction correction(const SightingSet& seen, const SlamPair& pair);
  void match(const SightingSet& seen, std::vector<SlamPair> pairs, std::vector<Match>& matches);
  void add_new(const SightingSet& seen, std::span<const SlamComparison> comparisons,
               std::vector<Match>& matches);
  void add(const SeenLandmark& seen, const Pose2& mount);
  void set_as_mapped(SlamLandmark& landmark, const MapLandmark& known) const;
  void add_line(const SeenLandmark& seen, const Pose2& mount);
  SlamState::Correction line_correction(std::size_t landmark, const SeenLandmark& seen, const Pose2& mount);
  const LinePiece& find_piece(std::size_t landmark, const LinePiece& now, const Eigen::Matrix2d& covariance);
  void set_site(const SlamLandmark& landmark);
  bool continues_line(const SeenLandmark& piece, const SightingSet& seen) const;
  void see_piece(SlamLandmark& landmark, const SeenLandmark& seen, const Pose2& sensor);
  void add(const BearingStarts::Start& start, const SightingSet& seen);
  void append(SlamLandmark fresh, const SeenLandmark& seen);
  void update_existence(const SightingSet& seen, std::span<const SlamCandidate> near,
                        const std::vector<bool>& found);
  MissedViews::Look look_at(const SightingSet& seen, const SlamCandidate& candidate, bool found) const;
  void revise_by_views(SlamLandmark& landmark, double evidence) const;
  void remove(SlamLandmark& landmark);
  Eigen::Vector2d position(std::size_t landmark) const;
  void check_relocalization(const SightingSet& seen, std::span<const SlamCandidate> near,
                            const std::vector<bool>& found);
  bool is_of_map(std::size_t sighting) const { return last_[sighting] && *last_[sighting] < map_.size(); }
  void compare_with_rival(const SightingSet& seen);
  void remember(const SightingSet& seen, std::span<const SlamCandidate> near, const std::vector<bool>& found);
  bool is_contradicted(const PoseEstimate& rival);
  void restart(const PoseEstimate& at);

  SlamOptions options_;
  SlamState state_;
  FixGate gnss_, heading_;
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
  double line_reach_ = 0;                                     ///< m, to the farther end of a line
  bool sees_bearings_ = false;                                ///< a sighting had no range
  BearingStarts starts_;
  double hits_ = 0, chances_ = 0;
  MissedViews missed_;  ///< of landmarks of the map
  std::size_t unplaced_ranges_ = 0;
  std::optional<SlamRelocalization> search_;
  PastSets past_;
  std::int64_t sets_ = 0;                           ///< of sightings so far
  std::unique_ptr<EkfSlam> rival_;                  ///< started at the pose under trial
  std::unique_ptr<MultiHypothesisFilter> tracker_;  ///< follows the robot in the map as given
  ChanceFraction chance_;
  SetEvidence in_map_;       ///< of the last set: `fit` and `chance`
  std::size_t trusted_ = 0;  ///< number of landmarks when the map was last seen
  int restarts_ = 0;
};

}  // namespace waymark::localization
