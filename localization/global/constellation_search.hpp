// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "localization/global/constellation.hpp"
namespace waymark {

/// The plane that touches the ground at a landmark.
TangentPlane plane_at(const PlacedLandmark& place);
/// Rotates robot coordinates into those of the plane.
Eigen::Matrix2d turned(double yaw);
/// On the plane, at the true distance from its origin.
Eigen::Vector2d flattened(const TangentPlane& plane, const Eigen::Vector3d& at);

/// One question to a ConstellationIndex: guesses of triangles or names (constellation_search.cpp), the best
/// of them fitted and judged (constellation_fit.cpp).
class ConstellationSearch {
 public:
  ConstellationSearch(const ConstellationIndex& index, const SightingSet& seen);
  ConstellationAnswer find();

 private:
  struct Seen {
    std::size_t index = 0;  // in the set
    const SeenLandmark* sighting = nullptr;
    Eigen::Vector2d at;  // from the robot
    Eigen::Matrix2d covariance;
    double range = 0, sd = 0, rarity = 1;
    std::optional<std::uint32_t> named;
  };
  /// A pose that three sightings and three landmarks vote for.
  struct Guess {
    std::uint32_t anchor;    // landmark whose plane the pose is on
    Eigen::Vector2d middle;  // where the middle of the sightings is
    double yaw, weight;
  };
  using Matches = std::vector<std::optional<std::uint32_t>>;
  using Hit = std::pair<std::array<const Seen*, 3>, std::array<std::uint32_t, 3>>;
  void add(const SightingSet& seen, std::size_t i);
  bool alike(const Seen& s, std::uint32_t landmark) const;
  /// Part of the landmarks that a sighting could be by type and features.
  double rarity(const Seen& s) const;
  void guess(std::uint32_t anchor, const std::array<const Seen*, 3>& seen,
             const std::array<std::uint32_t, 3>& landmarks, std::size_t count, double weight);
  void guess_by_names();
  void guess_by_triangles();
  void look_up(const std::array<std::size_t, 3>& triple);
  // Corner i lies opposite side i, longest first.
  void look_up(const std::array<const Seen*, 3>& c);
  void compare(const std::array<const Seen*, 3>& c, const std::array<std::uint32_t, 3>& corners,
               const std::array<double, 3>& side, const std::array<double, 3>& slack, double x, double y,
               bool left);
  // A sighting without a type may be of any.
  std::vector<std::array<TypeId, 3>> types_of(const std::array<const Seen*, 3>& c) const;
  // Guesses that agree stand together; the best of each crowd is fitted.
  std::vector<ConstellationFix> fitted();
  static double badness(const ConstellationFix& f) { return f.log_false_alarms + f.squares / 2; }
  // The same pose found twice counts once.
  void keep(std::vector<ConstellationFix>& fixes, ConstellationFix fix) const;
  static double near_enough(const ConstellationFix& a, const ConstellationFix& b);
  struct Local {
    std::uint32_t landmark;
    Eigen::Vector2d at;
  };
  std::optional<ConstellationFix> fit(const Guess& g) const;
  Eigen::Matrix2d spread(const Seen& s, const Pose2& pose, std::uint32_t landmark) const;
  // One sighting per landmark, the nearest pairs first. Indices into `locals`.
  Matches match(const Pose2& pose, const std::vector<Local>& locals, double slack) const;
  // Gauss-Newton step of the weighted least squares over all that matched.
  bool adjust(PoseEstimate& e, const Matches& matches, const std::vector<Local>& locals) const;
  // How many poses of the whole map would match as much by chance.
  ConstellationFix judged(const PoseEstimate& e, const TangentPlane& plane, const Matches& matches,
                          const std::vector<Local>& locals) const;
  std::string_view verdict(const std::vector<ConstellationFix>& fixes, std::size_t named) const;
  const ConstellationIndex& index_;
  const ConstellationOptions& o_;
  std::vector<Seen> points_;
  std::size_t total_ = 0;
  Eigen::Vector2d middle_ = Eigen::Vector2d::Zero();
  double extent_ = 0;
  std::vector<Hit> hits_;
  std::vector<Guess> guesses_;
};

}  // namespace waymark
