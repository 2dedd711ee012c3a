// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>
#include "core/options.hpp"
#include "localization/identification/landmark_grid.hpp"
#include "localization/line_of_sight.hpp"
#include "localization/localizer.hpp"
#include "localization/slam/slam_search.hpp"
#include "localization/slam/slam_state.hpp"
namespace waymark {

struct SlamOptions {
  double match = 9.21;     ///< squared Mahalanobis distance up to which a sighting is a landmark
  double fresh = 25;       ///< and beyond which it is a new one; between the two it is ambiguous and not used
  double nearest = 2;      ///< m: no new landmark closer than this to another
  double most_range = 40;  ///< m; sightings farther away are not used
  double seen = 0.85;      ///< log odds a match adds to a landmark's existence
  double unseen = -0.5;    ///< log odds that being expected and not seen adds, at most
  double confirmed = 2;    ///< log odds from which a landmark is written into a map
  double dropped = -1;     ///< log odds below which it is forgotten
  double field_of_view = 1.4;       ///< rad to each side where sightings are expected
  double margin = 15;               ///< m driven between two updates of the landmarks out of sight
  double feature_tolerance = 0.15;  ///< relative standard deviation two looks at a thing may disagree by
  double feature_limit = 9;         ///< squared standard deviations a feature of a landmark may differ
  double quality_floor = 0.1;       ///< noise of a landmark of quality q is divided by max(q, this)
  bool use_identities = true;       ///< believe landmarks that say who they are

  void describe(OptionVisitor& option);
};

/// A landmark that SLAM holds.
struct SlamLandmark {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  double log_odds = 0;  ///< that it exists: the evidence counter of section 4.4
  std::int64_t matches = 0;
  std::int64_t expected = 0;       ///< sets of sightings that should have shown it, matched ones too
  std::optional<LandmarkKey> key;  ///< of the map's landmark it is, or of the identity it was seen with
  bool gone = false;               ///< of the map, and the evidence says it is not there any more
  bool of_map = false;             ///< it was in the map the robot started with
  std::optional<TypeId> type;
  double quality = 1;                   ///< of the map's landmark
  KnownFeatures features;               ///< the signature
  std::vector<KnownFeatures> looks;     ///< features of each match, for the map's statistics; at most 100
  std::size_t index = 0;                ///< stays the same while the filter lives
  std::optional<SlamState::Slot> slot;  ///< nothing: it is known from the map and was not seen yet
};

/// Robot and landmarks in one Gaussian (section 4.4; Smith, Self & Cheeseman 1990), updated where the robot
/// is (SlamState). Starts with a map or with none: landmarks of the map enter the Gaussian with their
/// covariance when they are first seen, and their existence starts from their quality. Sightings that do not
/// say who they are are paired one to one, least distance first, features included; a band of ambiguity keeps
/// duplicates out. 0.2 ms per scan of 8 stems among 100 landmarks in reach.
class EkfSlam final : public Localizer {
 public:
  explicit EkfSlam(const PoseEstimate& start, SlamOptions options = {});
  EkfSlam(const PoseEstimate& start, LandmarkGrid map, FeatureScales scales, SlamOptions options = {},
          LineOfSight visible = {});
  void move(const BodyMotion& motion) override {
    pending_ = then(pending_, motion);
    if (search_) search_->move(motion);
  }
  std::vector<Match> see(const SightingSet& seen) override;
  Trust trust() const override;

  /// From now on it asks where it is when it does not find the landmarks of its map (SlamSearch), and begins
  /// anew there: landmarks of the map as the map has them, new ones of before it was lost as they are.
  void search_with(PoseFinder finder);
  int restarts() const { return restarts_; }
  PoseEstimate estimate() const override;

  /// Everything brought up to date: landmarks with places and covariances, those of the map that were not
  /// seen and those that are gone included, forgotten ones that were in no map not.
  std::vector<SlamLandmark> landmarks();
  /// The map's landmark of an index, as the map has it; null for what is in no map.
  const MapLandmark* prior(std::size_t index) const { return index < map_.size() ? &map_[index] : nullptr; }
  /// Index of the landmark of each sighting of the last set, new ones too; nothing for what was not used.
  const std::vector<std::optional<std::size_t>>& last() const { return last_; }
  /// How often a landmark that is surely there and in view is seen.
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
  void settle();
  std::vector<Near> in_reach(const SightingSet& seen) const;
  double features_apart(const SeenLandmark& seen, const SlamLandmark& landmark) const;
  void match(const SightingSet& seen, const std::vector<Pair>& chosen);
  void add(const SeenLandmark& seen, const Pose2& mount);
  void count(const std::vector<Near>& near, const std::vector<bool>& found);
  Eigen::Vector2d place(std::size_t landmark) const;
  void look_for_place(const SightingSet& seen, const std::vector<Near>& near, const std::vector<bool>& found);
  void begin_anew(const PoseEstimate& at);

  SlamOptions options_;
  SlamState state_;
  BodyMotion pending_;  ///< driven since the last sightings
  FeatureScales scales_;
  LineOfSight visible_;
  LandmarkGrid map_;                     ///< as given: where landmarks that were not seen yet are found
  std::vector<SlamLandmark> landmarks_;  ///< those of the map first, in the order of its grid
  std::vector<std::size_t> of_slot_;
  std::vector<std::optional<std::size_t>> last_;
  std::unordered_map<LandmarkKey, std::size_t> of_key_;
  Eigen::Vector2d centre_;       ///< where the neighbourhood was last chosen
  double reach_ = 0, view_ = 0;  ///< farthest range and widest bearing seen so far
  double hits_ = 0, chances_ = 0;
  std::optional<SlamSearch> search_;
  std::size_t trusted_ = 0;  ///< landmarks there were when the map was last seen
  int restarts_ = 0;
};

}  // namespace waymark
