// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <unordered_map>
#include <vector>
#include "core/options.hpp"
#include "localization/global/point_cells.hpp"
#include "localization/global/pose_finder.hpp"
#include "localization/identification/identification.hpp"
#include "localization/sighting.hpp"
namespace waymark::localization {

/// Options of localization by constellations of landmarks.
struct ConstellationOptions {
  std::int64_t neighbours = 7;  ///< nearest landmarks that make triangles with each one
  double sigmas = 3;            ///< standard deviations by which lengths and positions may differ
  double false_alarms = 1e-3;   ///< expected number of chance fixes allowed among all poses of the map
  double lead = 1000;  ///< factor by which the best pose must be less probable by chance than the next
  std::int64_t min_matches = 4;          ///< sightings that must have a landmark, unless they have identities
  std::int64_t max_tried = 60;           ///< poses that are fitted
  IdentificationOptions identification;  ///< its feature limits and use of identities; described by its owner
  /// The robot has known its pose. Then fewer guesses are compared with all sightings, and a second place
  /// that is alike needs less to be excluded: odometry judges the answers, and what is remembered of a robot
  /// that was carried away is of two places.
  bool had_pose = false;

  void describe(OptionVisitor& option);
};

/// Position of a landmark and its up vector: on a plane (up is z) or around a body, metres from its centre.
struct LandmarkPosition {
  Eigen::Vector3d at, up;
};

/// Plane on which a pose is fitted; touches the surface at `origin`.
struct TangentPlane {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero(), east = Eigen::Vector3d::UnitX(),
                  north = Eigen::Vector3d::UnitY();
  Eigen::Vector3d point(const Eigen::Vector2d& p) const { return origin + p.x() * east + p.y() * north; }
};

/// A pose that explains sightings.
struct ConstellationFix {
  TangentPlane plane;
  PoseEstimate plane_pose;                              ///< of the robot, about the plane's origin
  std::vector<std::optional<std::uint32_t>> landmarks;  ///< index into the map for each sighting
  int matched = 0;
  double squares = 0;           ///< sum of squared distances of the matches
  double log_false_alarms = 0;  ///< ln of the expected number of poses of the map that fit as well by chance

  /// Returns the pose in the frame of a planar map.
  PoseEstimate pose() const;
};

/// Result of a search. `reason` says why there is no fix.
struct ConstellationAnswer {
  std::optional<ConstellationFix> fix;
  std::string_view reason = {};
  std::vector<ConstellationFix> candidates;  ///< best first, at most ten; the fix is the first
};

/// Index of the triangles of neighbouring landmarks of a whole map, by types, two lengths and orientation
/// (geometric hashing of star maps: Groth 1986; Lang et al. 2010). A triangle is seen only if all its
/// corners are, so each landmark is in many. About 200 bytes and 4 us per landmark. Immutable; several
/// threads may search.
class ConstellationIndex {
 public:
  /// Indexes a planar map, without the landmarks that rather do not exist (probability below 0.5) if the
  /// others are expected to be most of those that exist.
  ConstellationIndex(std::vector<MapLandmark> landmarks, FeatureScales scales,
                     ConstellationOptions options = {});
  /// Indexes a map around a body. `positions` are parallel to the landmarks, whose own `at` is not used.
  ConstellationIndex(std::vector<MapLandmark> landmarks, std::vector<LandmarkPosition> positions,
                     FeatureScales scales, ConstellationOptions options = {});

  /// Returns the pose from which the sightings were made. Sightings need a range.
  /// - Departures from the textbook: instead of pairwise consistency cliques, the poses with most votes are
  ///   fitted, and every sighting is compared with the map.
  /// - A fix must be better than any other pose and too good for chance (a contrario: Desolneux, Moisan &
  ///   Morel 2000). Chance follows from the local density of landmarks and the rarity of their features.
  /// - A second pose that chance does not explain either shows that the map repeats itself. The fix then
  /// needs
  ///   five matches more than it (one landmark in five may be missing in the map).
  ConstellationAnswer find(const SightingSet& seen) const;
  /// Returns the fix next to an expected pose of a planar map, if it is too good for chance in the whole map.
  /// Does not search for other poses.
  std::optional<ConstellationFix> check(const SightingSet& seen, const Pose2& expected) const;
  /// Returns the pose of a planar map, among those that a prior allows, from which the sightings were made.
  /// Chance is that of these poses, not of the whole map. 0.5 to 2 ms for 1 to 10 m.
  ConstellationAnswer find_near(const SightingSet& seen, const PoseEstimate& prior) const;

  std::size_t size() const { return landmarks_.size(); }
  std::size_t triangles() const { return corners_.size(); }
  std::size_t bytes() const;
  const MapLandmark& operator[](std::size_t i) const { return landmarks_[i]; }

 private:
  friend class ConstellationSearch;
  using Corners = std::array<std::uint32_t, 3>;
  void build();
  std::vector<Corners> neighbour_triangles() const;
  std::uint64_t key(std::array<TypeId, 3> types, double longest, double middle, bool left) const;
  std::size_t bucket(std::uint64_t key) const { return key & (first_.size() - 2); }
  /// Orders the corners so that the longest side is opposite the first and the shortest opposite the last.
  /// `std::nullopt` for triangles too flat or small to have an orientation.
  std::optional<Corners> order_corners(Corners c) const;
  bool turns_left(const Corners& c) const;

  std::vector<MapLandmark> landmarks_;
  std::vector<LandmarkPosition> positions_;
  FeatureScales scales_;
  ConstellationOptions options_;
  PointCells cells_;
  std::vector<Corners> corners_;       // by bucket
  std::vector<std::uint32_t> first_;   // of each bucket; one more than buckets
  std::vector<TypeId> types_;          // types in the map
  std::vector<std::uint32_t> sample_;  // landmarks to estimate how rare a feature is
  std::unordered_map<LandmarkKey, std::uint32_t> by_key_;
  double length_cell_ = 1, typical_sd_ = 0, area_ = 1;
};

}  // namespace waymark::localization
