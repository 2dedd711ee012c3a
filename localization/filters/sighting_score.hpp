// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "localization/filters/particle_weights.hpp"
#include "localization/identification/identification.hpp"
namespace waymark {

/// Weighs poses by one set of sightings. Made once per set, then asked for each particle from any thread:
/// about 60 ns per sighting where the map holds a few landmarks inside the gate, whatever its size; 20 ns for
/// poses of a cloud it has been shown.
class SightingScore {
 public:
  /// `map` and `scales` must outlive it. Unsound sightings are left out.
  SightingScore(const SightingSet& seen, const LandmarkGrid& map, const FeatureScales& scales,
                const WeightOptions& options, bool use_identities);

  /// Looks up once which landmarks the sightings could be of from any of these poses, and compares their
  /// features. No score changes by it; other poses are looked up in the map each for itself.
  void gather(std::span<const Pose2> poses);

  /// The fit of each pose, as operator() tells it but for rounding.
  void operator()(std::span<const Pose2> poses, std::span<double> fit) const;

  /// `likelihood`: sum over sightings of the log of (clutter + best landmark's density times quality), and
  /// with `expect_unseen` the sum of log(1 - q detection) over landmarks in view that no sighting is nearest
  /// to. What stands between is not known: in dense forest choose `view_range` so that most is seen.
  /// `paper`: e of eq. 12, the sum of match distances times qualities.
  double operator()(const Pose2& robot) const;
  std::size_t sightings() const { return prepared_.size(); }
  /// Landmarks that cannot be seen from where the robot about is, ascending: they are not expected.
  void hide(std::vector<std::uint32_t> landmarks) { hidden_ = std::move(landmarks); }
  /// The sum of log(1 - q detection) over landmarks in view that are not among those matched.
  double unseen(const Pose2& robot, std::span<const std::uint32_t> matched) const;

 private:
  /// What of a landmark and a sighting does not depend on the pose.
  struct Likeness {
    double scale;              ///< `likelihood`: the density is this times exp(-squares / 2) / sqrt(det)
    double features, quality;  ///< `paper`: the cost is (squares + features) times quality
  };
  struct Candidate {
    std::uint32_t landmark;
    Eigen::Vector2d at;
    Eigen::Matrix2d covariance;
    Likeness likeness;
  };
  struct Prepared {
    SeenLandmark seen;
    double cosine, sine;  ///< of the bearing
    double range_variance, bearing_variance;
    double radius;   ///< m about the expected place; about the sensor where there is no range
    double clutter;  ///< density where no landmark fits
    double gate;
    bool known = false;     ///< it says who it is
    bool gathered = false;  ///< `candidates` are all there are for poses of the cloud; of a known one always
    std::vector<Candidate> candidates;
  };
  /// A box of poses.
  struct Cloud {
    Pose2 middle;
    Eigen::Vector2d half = {-1, -1};
    double turn = -1;  ///< rad, largest difference of heading

    bool holds(const Pose2& pose) const {
      return std::abs(pose.x - middle.x) <= half.x() && std::abs(pose.y - middle.y) <= half.y() &&
             std::abs(wrapped(pose.yaw - middle.yaw)) <= turn;
    }
  };
  template <class T>
  struct View;
  template <class T>
  struct Place;
  struct Best {
    double value;  ///< `likelihood`: a density, 0 where nothing fits; `paper`: a cost, infinite there
    std::uint32_t landmark;
  };
  static Cloud cloud_of(std::span<const Pose2> poses);
  void gather(Prepared& p, const Pose2& sensor, double radius);
  template <class T>
  Place<T> place(const Prepared& p, const Eigen::Vector2d& at, const Eigen::Matrix2d& covariance,
                 const View<T>& view) const;
  template <class T>
  T value(const Place<T>& place, const Likeness& likeness) const;
  std::optional<Likeness> likeness(const Prepared& p, std::uint32_t landmark) const;
  Best best(const Prepared& p, const View<double>& view, bool in_cloud) const;
  void several(const Pose2* poses, double* fit) const;
  double log_unseen(std::uint32_t landmark) const;
  double unseen(const Eigen::Vector2d& sensor, double cosine, double sine,
                std::span<const std::uint32_t> matched) const;

  const LandmarkGrid* map_;
  const FeatureScales* scales_;
  WeightOptions options_;
  Pose2 robot_from_sensor_;
  std::vector<Prepared> prepared_;
  bool paper_;
  Cloud cloud_;
  bool alike_ = false;  // poses of the cloud have the same candidates, and can be asked several at once
  std::vector<std::uint32_t> hidden_;
  std::vector<TypeId> types_;  // that the sensor sees, as far as this set tells
};

}  // namespace waymark
