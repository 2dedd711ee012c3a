// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>
#include "core/options.hpp"
#include "localization/craters/image_pose.hpp"
#include "localization/global/point_cells.hpp"
namespace waymark::localization {

/// Crater of a whole body.
struct BodyCrater {
  Eigen::Vector3d at;  ///< middle of the rim, metres from the body's centre
  double radius = 0;   ///< metres
  double sd = 0;       ///< metres, of each horizontal coordinate
};

/// Crater detected in an image: pixels right and down from its middle.
struct ImageCrater {
  Eigen::Vector2d at;
  double radius = 0;
};

/// Options of the search for an image among the craters of a body.
struct CraterSearchOptions {
  std::int64_t neighbours = 6;   ///< nearest craters of at least about its size that make triangles with each
  double position_sd = 1;        ///< px, of a detection
  double position_error = 0.05;  ///< of a detection and its crater, as a fraction of the radius
  double radius_error = 0.12;    ///< standard deviation of ln of radii, detection against map
  double mapped = 0.6;           ///< fraction of the detections expected to be in the map
  double tilt_sd = 2;            ///< degrees off the vertical, of a camera
  double sigmas = 3;
  double max_wrong = 1e-3;  ///< largest probability of being wrong of an accepted position
  std::int64_t min_matches = 5;
  std::int64_t max_tried = 100;         ///< positions that are fitted
  std::int64_t max_detections = 150;    ///< detections that are used, the largest
  double min_scale = 0, max_scale = 0;  ///< metres per pixel; 0: unknown

  void describe(OptionVisitor& option);
};

/// Image as it was taken.
struct CraterImage {
  std::span<const ImageCrater> craters;
  Eigen::Vector2d size = Eigen::Vector2d::Zero();  ///< px; 0: the box of the craters
  GroundCamera camera{};
};

/// Position of an image among the craters of a map.
struct CraterFix {
  ImagePose pose;
  ImagePose::Covariance covariance;                   ///< of the parameters of ImagePose::moved()
  std::vector<std::optional<std::uint32_t>> craters;  ///< index into the map, for each crater of the image
  int matched = 0;
  double residual = 0;          ///< px, root mean square distance of the matches
  double log_false_alarms = 0;  ///< ln of the expected number of positions that fit as well by chance
};

/// Result of a search. `reason` says why there is no fix.
struct CraterAnswer {
  std::optional<CraterFix> fix;
  double wrong = 1;  ///< probability that the best candidate is not the position
  std::string_view reason = {};
  std::vector<CraterFix> candidates;  ///< best first, at most ten; the fix is the first
};

/// Index of triangles of neighbouring craters of a whole body (geometric hashing; of craters: Cheng et al.
/// 2003; of stars: Lang et al. 2010). About 20 us and 450 bytes per crater. Immutable; several threads may
/// search.
/// - The key is two ratios of sides, three of radii to the longest side, and the sense of rotation. None
///   depends on scale, turn or position.
/// - Each crater makes triangles with its nearest neighbours of at least 0.8 of its radius. An image with all
///   craters of that size has the same triangles at any scale.
class CraterIndex {
 public:
  CraterIndex(std::vector<BodyCrater> craters, const Body& body, CraterSearchOptions options = {});

  /// Returns where an image was taken; the search area is the whole body. Deterministic for any number of
  /// threads. 0.1 to 2 s of one core.
  /// - Triangles of the image propose positions. Each is scored by the craters around the triangle, and the
  ///   best are adjusted to all (crater_fit.cpp).
  /// - Evidence: a detection is any crater of the map in view, or arbitrary. Its ratio to arbitrary
  ///   detections alone exceeds x by chance at most once in x positions (Markov's inequality).
  CraterAnswer find(const CraterImage& image) const;
  CraterAnswer find(const CraterImage& image, const CraterSearchOptions& options) const;

  std::size_t size() const { return craters_.size(); }
  std::size_t triangles() const { return corners_.size(); }
  std::size_t bytes() const;
  const BodyCrater& operator[](std::size_t i) const { return craters_[i]; }

 private:
  friend class CraterSearch;
  friend class CraterFitter;
  using Corners = std::array<std::uint32_t, 3>;
  /// Craters of at least a radius.
  struct Level {
    double min_radius = 0;
    std::vector<std::uint32_t> members;
    PointCells cells;
  };
  void make_levels();
  void make_triangles();
  void neighbour_triangles(std::uint32_t i, std::vector<Corners>& into) const;
  /// Orders the corners so that the longest side is opposite the first and the shortest opposite the last.
  std::optional<Corners> order_corners(Corners c) const;
  std::size_t cell_of(const Corners& c) const;
  bool turns_left(const Corners& c) const;
  /// Returns the smallest level with all craters of that radius.
  const Level& level(double radius) const;
  /// Calls visit(index, squared distance) for the craters of at least `min_radius`, and some smaller ones.
  template <class Visit>
  void near(const Eigen::Vector3d& at, double reach, double min_radius, Visit&& visit) const {
    const Level& l = level(min_radius);
    l.cells.near(at, reach, [&](std::uint32_t k, double d) { visit(l.members[k], d); });
  }
  /// Returns the number of craters per square metre and unit of ln of the radius.
  double density(double log_radius) const;

  BodySurface surface_;
  std::vector<BodyCrater> craters_;
  std::vector<Eigen::Vector3d> points_;  // on the surface
  CraterSearchOptions options_;
  std::vector<Level> levels_;         // from the smallest radius
  std::vector<Corners> corners_;      // by cell
  std::vector<std::uint32_t> first_;  // of each cell; one more than cells
  std::vector<double> density_;       // by ln of the radius
  double min_log_radius_ = 0;
};

}  // namespace waymark::localization
