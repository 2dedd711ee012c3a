// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <vector>
#include "core/options.hpp"
#include "localization/localizer.hpp"
namespace waymark::localization {

/// Options of localization and mapping by ranges to beacons.
struct RangeSlamOptions {
  double offset_sd = 0;    ///< m: offset of all ranges to one beacon, which lasts the drive; 0: none
  double outliers = 0.05;  ///< fraction of ranges that are echoes, while a beacon's position is open

  void describe(OptionVisitor& option);
};

/// Beacon of a map.
struct RangeBeacon {
  LandmarkKey key = 0;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();          ///< map frame, m
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< m^2
  double height = 0;                                     ///< m above the antenna
};

/// Extended Kalman filter over pose, beacons and their offsets, by ranges to identified beacons.
/// - State: the pose, then position and offset of each beacon. Beacons of the map begin with its covariance,
///   and are refined.
/// - An unknown beacon begins as a ring of hypotheses about its first range (Djugash et al. 2006;
///   Caballero et al. 2008). Each is corrected by later ranges without correcting the pose (Schmidt 1966), so
///   the covariance holds whichever is right. One that is left with almost all weight becomes a beacon like
///   the others.
/// - Two positions on both sides of a straight drive stay open until the robot turns.
/// - Sightings with a bearing, or without identity, are left out.
/// - O(n^2) per range and hypothesis for n beacons.
class RangeSlam final : public Localizer {
 public:
  RangeSlam(const PoseEstimate& start, std::vector<RangeBeacon> beacons, RangeSlamOptions options = {});

  void predict(const BodyMotion& motion) override;
  std::vector<Match> update(const SightingSet& seen) override;
  bool fix(const GnssFix& gnss) override;
  bool fix(const HeadingFix& heading) override;
  PoseEstimate estimate() const override;

  /// Estimate of a beacon.
  struct Placed {
    LandmarkKey key = 0;
    Eigen::Vector3d mean;        ///< position (m, map frame) and offset (m)
    Eigen::Matrix3d covariance;  ///< of these
  };
  /// Returns the beacons whose positions are certain, those of the map first.
  std::vector<Placed> beacons() const;
  /// Returns the number of beacons whose positions are still open.
  std::size_t open_beacons() const;

 private:
  struct Hypothesis {
    Eigen::Index row = 0;  // of position and offset in the state
    double log_weight = 0;
  };
  struct Beacon {
    LandmarkKey key = 0;
    double height = 0;
    std::vector<Hypothesis> hypotheses = {};
    bool is_open() const { return hypotheses.size() > 1; }
  };
  /// A range as a linear function of the state.
  struct Prediction {
    double value = 0, variance = 0;  // of what is not linear
    Eigen::VectorXd row;
  };
  Prediction predict_range(const Pose2& mount, const Beacon& beacon, Eigen::Index row) const;
  void correct(const Prediction& p, double innovation, double noise, Eigen::Index first, Eigen::Index count);
  /// Measurement that is linear in the state.
  struct Measurement {
    Eigen::MatrixXd rows;
    Eigen::VectorXd innovation;
    Eigen::MatrixXd noise;
  };
  void apply(const Eigen::MatrixXd& gain, const Measurement& m);
  bool update(Beacon& beacon, const SeenLandmark& seen, const Pose2& mount);
  /// Range to a beacon that was heard once, and the distance driven until then.
  struct FirstRange {
    LandmarkKey key = 0;
    double range = 0, driven = 0;
  };
  /// Returns whether a range agrees with the first one to its beacon; keeps the shorter, as echoes are long.
  bool is_confirmed(const SeenLandmark& seen);
  void start_ring(const SeenLandmark& seen, const Pose2& mount);
  void weigh(Beacon& beacon, const SeenLandmark& seen, const Pose2& mount);
  void prune(Beacon& beacon);
  void remove_rows(Eigen::Index row);
  bool measure(const Measurement& m);

  RangeSlamOptions options_;
  Eigen::VectorXd mean_;
  Eigen::MatrixXd covariance_;
  std::vector<Beacon> beacons_;
  std::vector<FirstRange> first_;
  double driven_ = 0;  // m
};

}  // namespace waymark::localization
