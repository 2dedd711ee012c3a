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
#include "localization/identification/feature_distance.hpp"
#include "localization/sighting.hpp"
namespace waymark {

struct ConstellationOptions {
  std::int64_t neighbours = 7;      ///< of each landmark that make triangles with it
  double sigmas = 3;                ///< standard deviations that lengths and places may differ by
  double feature_limit = 9;         ///< squared standard deviations one feature may differ by
  double feature_tolerance = 0.15;  ///< part of a feature's value two sensors may disagree by
  double false_alarms = 1e-3;       ///< fixes by chance that are allowed among all poses of the map
  double lead = 1000;               ///< by which the best pose must be less probable by chance than the next
  std::int64_t least_matches = 4;   ///< sightings that must have a landmark, unless they say who they are
  std::int64_t most_tried = 60;     ///< poses examined closely
  bool use_identities = true;

  void describe(OptionVisitor& option);
};

/// Where landmarks lie: on a plane (up is z) or round a body, metres from its centre.
struct PlacedLandmark {
  Eigen::Vector3d at, up;
};

/// The plane on which a pose was fitted: it touches the ground at `origin`.
struct TangentPlane {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero(), east = Eigen::Vector3d::UnitX(),
                  north = Eigen::Vector3d::UnitY();
  Eigen::Vector3d place(const Eigen::Vector2d& p) const { return origin + p.x() * east + p.y() * north; }
};

/// A pose that explains sightings.
struct ConstellationFix {
  TangentPlane plane;
  PoseEstimate on_plane;                                ///< of the robot, about the plane's origin
  std::vector<std::optional<std::uint32_t>> landmarks;  ///< of each sighting: index into the map
  int matched = 0;
  double squares = 0;           ///< sum of squared distances of what matched
  double log_false_alarms = 0;  ///< ln of the number of poses of the map that fit as well by chance

  /// Of a map on a plane: in its frame.
  PoseEstimate pose() const;
};

/// Answer to "where am I?". Without a fix, `reason` says why not.
struct ConstellationAnswer {
  std::optional<ConstellationFix> fix;
  std::string_view reason = {};
  std::vector<ConstellationFix> candidates;  ///< best first, at most ten; the fix is the first
};

/// Triangles of neighbouring landmarks of a whole map, found again by types, two lengths and orientation
/// (geometric hashing of star maps: Groth 1986; Lang et al. 2010). A triangle is seen only where its three
/// corners are, so each landmark is in many. About 200 bytes and 4 us per landmark. Immutable; many threads
/// may ask.
class ConstellationIndex {
 public:
  /// A map on the plane.
  ConstellationIndex(std::vector<MapLandmark> landmarks, FeatureScales scales,
                     ConstellationOptions options = {});
  /// A map that goes round a body: places beside the landmarks, whose own `at` is not used.
  ConstellationIndex(std::vector<MapLandmark> landmarks, std::vector<PlacedLandmark> places,
                     FeatureScales scales, ConstellationOptions options = {});

  /// The pose from which these would be seen. Sightings need a range. Departures from the textbook: instead
  /// of pairwise consistency cliques, poses that gather most votes are fitted and every sighting is compared
  /// with the map; a fix must be too good for chance (a contrario: Desolneux, Moisan & Morel 2000), given the
  /// density of landmarks there and how rare their features are, and better than any other pose.
  ConstellationAnswer find(const SightingSet& seen) const;

  std::size_t size() const { return landmarks_.size(); }
  std::size_t triangles() const { return corners_.size(); }
  std::size_t bytes() const;
  const MapLandmark& operator[](std::size_t i) const { return landmarks_[i]; }

 private:
  friend class ConstellationSearch;
  using Corners = std::array<std::uint32_t, 3>;
  void build();
  std::vector<Corners> neighbouring() const;
  std::uint64_t key(std::array<TypeId, 3> types, double longest, double middle, bool left) const;
  std::size_t bucket(std::uint64_t key) const { return key & (first_.size() - 2); }
  /// Corners so that the longest side lies opposite the first and the shortest opposite the last; nothing
  /// for triangles too flat or small to tell how they turn.
  std::optional<Corners> ordered(Corners c) const;
  bool turns_left(const Corners& c) const;

  std::vector<MapLandmark> landmarks_;
  std::vector<PlacedLandmark> places_;
  FeatureScales scales_;
  ConstellationOptions options_;
  PointCells cells_;
  std::vector<Corners> corners_;       // by bucket
  std::vector<std::uint32_t> first_;   // of each bucket, one more than buckets
  std::vector<TypeId> types_;          // that occur
  std::vector<std::uint32_t> sample_;  // of landmarks, for how rare a feature is
  std::unordered_map<LandmarkKey, std::uint32_t> by_key_;
  double length_cell_ = 1, typical_sd_ = 0, area_ = 1;
};

}  // namespace waymark
