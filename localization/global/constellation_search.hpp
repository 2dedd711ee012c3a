// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "localization/global/constellation.hpp"
namespace waymark::localization {

/// Returns the plane that touches the surface at a landmark.
TangentPlane plane_at(const LandmarkPosition& place);
/// Returns the rotation from robot coordinates to those of the plane.
Eigen::Matrix2d rotation(double yaw);
/// Returns the volume of the poses of a Gaussian, m^2 rad: that of an even distribution as likely at its
/// middle.
double volume_of(const Eigen::Matrix3d& covariance);
/// Maps a point to the plane, at its true distance from the origin.
Eigen::Vector2d flatten(const TangentPlane& plane, const Eigen::Vector3d& at);

/// One search in a ConstellationIndex. Triangles or identities vote for poses (constellation_search.cpp);
/// the best are fitted and evaluated (constellation_fit.cpp).
class ConstellationSearch {
 public:
  ConstellationSearch(const ConstellationIndex& index, const SightingSet& seen);
  ConstellationAnswer find();
  std::optional<ConstellationFix> check(const Pose2& expected);
  ConstellationAnswer find_near(const PoseEstimate& prior);

 private:
  struct Seen {
    std::size_t index = 0;  // in the set
    const SeenLandmark* sighting = nullptr;
    KnownFeatures features;  // without angles, since the heading is unknown
    double mount_yaw = 0;    // of the sensor that measured the angles
    Eigen::Vector2d at;      // from the robot
    Eigen::Matrix2d covariance;
    double range = 0, sd = 0, rarity = 1;
    std::optional<std::uint32_t> named;
  };
  /// Pose of three matched sightings and landmarks.
  struct Guess {
    std::uint32_t anchor;    // landmark on whose plane the pose is
    Eigen::Vector2d middle;  // position of the centroid of the sightings
    double yaw, weight;
  };
  /// Guesses of nearly one pose.
  struct Crowd {
    double weight = 0;
    std::size_t first = 0;  // index of the best one
  };
  using Matches = std::vector<std::optional<std::uint32_t>>;
  using Hit = std::pair<std::array<const Seen*, 3>, std::array<std::uint32_t, 3>>;
  void add(const SightingSet& seen, std::size_t i);
  /// Returns whether the angles of a sighting agree with those of a landmark of its type at a heading.
  bool faces_alike(const Seen& s, std::uint32_t landmark, double yaw) const;
  bool alike(const Seen& s, std::uint32_t landmark) const;
  /// Returns the fraction of the landmarks that a sighting could be by type and features.
  double rarity(const Seen& s) const;
  void guess(std::uint32_t anchor, const std::array<const Seen*, 3>& seen,
             const std::array<std::uint32_t, 3>& landmarks, std::size_t count, double weight);
  void guess_by_names();
  void guess_by_triangles();
  // By votes of single sightings, for the poses within three standard deviations of a prior.
  void guess_near(const PoseEstimate& prior);
  void look_up(const std::array<std::size_t, 3>& triple);
  // Corner i is opposite side i, longest first.
  void look_up(const std::array<const Seen*, 3>& c);
  void compare(const std::array<const Seen*, 3>& c, const std::array<std::uint32_t, 3>& corners,
               const std::array<double, 3>& side, const std::array<double, 3>& slack, double x, double y,
               bool left);
  // A sighting without a type may be of any type.
  std::vector<std::array<TypeId, 3>> possible_types(const std::array<const Seen*, 3>& c) const;
  // Groups similar guesses and fits the best of each group.
  std::vector<ConstellationFix> fit_guesses();
  // Returns the guesses to fit: of those with most votes, and of those that a part of the sightings fits
  // best, the ones that explain most.
  std::vector<std::size_t> best_guesses(std::vector<Crowd> by_votes) const;
  // Returns the sum of the information of the sightings with a landmark near, -ln of their chance. Compares
  // at most `max_count` of them, near and far ones.
  double support(const Guess& g, std::size_t max_count) const;
  static double badness(const ConstellationFix& f) { return f.log_false_alarms; }
  // Adds a fix unless the same pose was found already.
  void keep(std::vector<ConstellationFix>& fixes, ConstellationFix fix) const;
  static double combined_sd(const ConstellationFix& a, const ConstellationFix& b);
  struct Local {
    std::uint32_t landmark;
    Eigen::Vector2d at;
  };
  std::optional<ConstellationFix> fit(const Guess& g) const;
  Eigen::Matrix2d spread(const Seen& s, const Pose2& pose, std::uint32_t landmark) const;
  // Matches each landmark with at most one sighting, the nearest pairs first. Indices into `locals`.
  Matches match(const Pose2& pose, const std::vector<Local>& locals, double slack) const;
  // Gauss-Newton steps of the weighted least squares over all matches.
  bool adjust(PoseEstimate& e, const Matches& matches, const std::vector<Local>& locals) const;
  // Returns the number of landmarks per m^2 that a sighting could be, in a disc of `area` about its position.
  double intensity_near(const Seen& s, const Pose2& pose, const std::vector<Local>& locals,
                        std::optional<std::uint32_t> except, double area) const;
  // Computes how many poses of the whole map would match as much by chance.
  ConstellationFix evaluate_fix(const PoseEstimate& e, const TangentPlane& plane, const Matches& matches,
                                const std::vector<Local>& locals) const;
  // Returns why a fix may be chance; empty if it is none.
  std::string_view objection(const ConstellationFix& fix, std::size_t named) const;
  std::string_view verdict(const std::vector<ConstellationFix>& fixes, std::size_t named) const;
  std::size_t count_named() const;
  const ConstellationIndex& index_;
  const ConstellationOptions& o_;
  double volume_;  // of the poses that are possible, m^2 rad
  std::vector<Seen> points_;
  std::size_t total_ = 0;
  Eigen::Vector2d middle_ = Eigen::Vector2d::Zero();
  double extent_ = 0;
  std::vector<Hit> hits_;
  std::vector<Guess> guesses_;
};

}  // namespace waymark::localization
