// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <span>
#include <vector>
#include "localization/filters/particle_weights.hpp"
#include "localization/identification/identification.hpp"
namespace waymark::localization {

/// Returns the factor on the map covariance of a landmark; empty: 1.
using MapErrorFactor = std::function<double(LandmarkKey)>;

/// Log likelihood of one set of sightings at a pose. Constructed once per set, then called for each
/// particle from any thread. About 60 ns per sighting with a few landmarks inside the gate, whatever the
/// size of the map; 20 ns for poses passed to prefetch().
class SightingScore {
 public:
  /// `map` and `scales` must outlive it. Omits invalid sightings. Uses clutter, quality floor, feature
  /// limits, reach of bearings and identities of `identification`.
  SightingScore(const SightingSet& seen, const LandmarkGrid& map, const FeatureScales& scales,
                const WeightOptions& options, const IdentificationOptions& identification,
                MapErrorFactor map_error = {});

  /// Looks up the candidate landmarks of the sightings for all these poses at once, and compares their
  /// features. Does not change any score; other poses look up the map one by one.
  void prefetch(std::span<const Pose2> poses);

  /// Computes the fit of each pose; equals operator() of each pose up to rounding.
  void operator()(std::span<const Pose2> poses, std::span<double> fit) const;

  /// Returns the fit of a pose.
  /// - `likelihood`: sum over sightings of the log of (clutter + best landmark's density times quality).
  ///   With `expect_unseen`, plus log(1 - q detection) for each landmark in view that no sighting is
  ///   nearest to. Occlusion is unknown: in dense forest choose `view_range` so that most landmarks are
  ///   seen.
  /// - `paper`: e of eq. 12, the sum of match(d) times the quality of the landmark of least distance.
  double operator()(const Pose2& robot) const;
  std::size_t sightings() const { return prepared_.size(); }
  /// Sets the landmarks that are hidden from the robot, ascending: they are not expected.
  void hide(std::vector<std::uint32_t> landmarks) { hidden_ = std::move(landmarks); }
  /// Returns the sum of log(1 - q detection) over landmarks in view that are not matched.
  double unseen(const Pose2& robot, std::span<const std::uint32_t> matched) const;

 private:
  /// Terms of a landmark and a sighting that do not depend on the pose.
  struct PoseFreeTerms {
    double scale;     ///< `likelihood`: the density is this times exp(-squares / 2) / sqrt(det)
    double features;  ///< `paper`: their part of the distance of eq. 11
  };
  struct Prepared;
  /// Bounds that no landmark inside the gate exceeds, whatever the correlation of its errors. They need
  /// neither an inverse nor an angle.
  struct GateBounds {
    GateBounds(const Prepared& p, double sd);
    double off;                     ///< m: largest difference of the ranges; infinite without a range
    double min_square, max_square;  ///< m^2: squared distance from the sensor
    double near, widening;          ///< left^2 <= near + widening * squared distance from the sensor
    /// Returns a positive number for a landmark outside the bounds. `left`: its distance from the line of
    /// sight, m; `square`: its squared distance from the sensor.
    template <class T>
    T excess(const T& left, const T& square) const;
  };
  struct Candidate {
    std::uint32_t landmark;
    Eigen::Vector2d at;
    Eigen::Matrix2d covariance;
    GateBounds bounds;
    PoseFreeTerms pose_free_terms;
  };
  struct Prepared {
    SeenLandmark seen;
    double cosine, sine;  ///< of the bearing
    double ahead;         ///< m along the bearing to the expected position; 0: that is not known
    double range_variance, bearing_variance;
    double radius;   ///< m about the expected position; about the sensor if `ahead` is 0
    double clutter;  ///< density of false sightings
    double gate;
    bool known = false;  ///< it has an identity
    bool turns = false;  ///< it has an axis, whose azimuth depends on the pose
    bool prefetched =
        false;  ///< `candidates` are complete for poses of the cloud; always so with an identity
    std::vector<Candidate> candidates;
  };
  /// A box of poses.
  struct Cloud {
    Pose2 middle;
    Eigen::Vector2d half = {-1, -1};
    double turn = -1;  ///< rad, largest difference of heading

    bool contains(const Pose2& pose) const {
      return std::abs(pose.x - middle.x) <= half.x() && std::abs(pose.y - middle.y) <= half.y() &&
             std::abs(wrap_angle(pose.yaw - middle.yaw)) <= turn;
    }
  };
  template <class T>
  struct View;
  template <class T>
  struct PositionMatch;
  struct Best {
    double value;  ///< `likelihood`: a density, 0 if nothing fits; `paper`: match(d) of eq. 10, infinite then
    std::uint32_t landmark;
  };
  static Cloud bounding_cloud(std::span<const Pose2> poses);
  void prefetch(Prepared& p, const Pose2& sensor, double radius);
  template <class T>
  PositionMatch<T> match_position(const Prepared& p, const Eigen::Vector2d& at,
                                  const Eigen::Matrix2d& covariance, const View<T>& view) const;
  PositionMatch<double> match_line(const Prepared& p, std::uint32_t landmark,
                                   const Eigen::Vector2d& sensor) const;
  template <class T>
  T value(const PositionMatch<T>& place, const PoseFreeTerms& pose_free_terms) const;
  std::optional<PoseFreeTerms> pose_free_terms(const Prepared& p, std::uint32_t landmark) const;
  std::optional<PoseFreeTerms> feature_terms(const Prepared& p, std::uint32_t landmark,
                                             const KnownFeatures& seen) const;
  Best best(const Prepared& p, const View<double>& view, bool in_cloud, double sensor_yaw) const;
  void score_lanes(const Pose2* poses, double* fit) const;
  double quality(std::uint32_t landmark) const;
  bool is_left_out(std::uint32_t landmark) const;
  Eigen::Matrix2d map_covariance(std::uint32_t landmark) const;
  double log_unseen(std::uint32_t landmark) const;
  double unseen(const Eigen::Vector2d& sensor, double cosine, double sine,
                std::span<const std::uint32_t> matched) const;

  const LandmarkGrid* map_;
  const FeatureScales* scales_;
  WeightOptions options_;
  IdentificationOptions identification_;
  MapErrorFactor map_error_;
  Pose2 robot_from_sensor_;
  std::vector<Prepared> prepared_;
  bool paper_;
  Cloud cloud_;
  bool shared_candidates_ = false;  // poses of the cloud share their candidates and are evaluated in groups
  std::vector<std::uint32_t> hidden_;
  std::vector<TypeId> types_;  // types in this set
};

}  // namespace waymark::localization
