// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "localization/identification/landmark_window.hpp"
#include "localization/localizer.hpp"
namespace waymark {

struct KalmanOptions {
  std::int64_t lost_after = 10;  ///< sets in a row without a match until the search begins
  double search_growth = 2;      ///< by which the standard deviations grow with each further set; 1: not

  void describe(OptionVisitor& option);
};

/// What extended and unscented filter share: identification, gates, and recovery. A filter that rejects all
/// it sees for `lost_after` sets doubts itself and widens its covariance until something fits; otherwise a
/// gate that is too tight would reject for ever.
class KalmanLocalizer : public Localizer {
 public:
  KalmanLocalizer(LandmarkWindow map, FeatureScales scales, IdentificationOptions identification,
                  KalmanOptions options);
  std::vector<Match> see(const SightingSet& seen) final;
  bool fix(const GnssFix& gnss) final { return take(gnss, 2); }
  bool fix(const HeadingFix& heading) final { return take(heading, 1); }
  Trust trust() const final { return missed_ >= options_.lost_after ? Trust::lost : Trust::sure; }

 protected:
  struct Use {
    const SeenLandmark* seen = nullptr;
    const MapLandmark* landmark = nullptr;
    double trust = 1;
  };
  virtual void update(const std::vector<Use>& uses, const Pose2& robot_from_sensor) = 0;
  virtual void replace(const PoseEstimate& estimate) = 0;
  virtual void widen(double factor) = 0;

 private:
  template <class Fix>
  bool take(const Fix& measured, int rows);

  LandmarkWindow map_;
  FeatureScales scales_;
  IdentificationOptions identification_;
  KalmanOptions options_;
  std::int64_t missed_ = 0;
  FixGate gnss_, heading_;
};

/// Extended Kalman filter (eqs. 15-16). Departures: x and P on the right are the predicted ones, as they must
/// be; the covariance is updated in Joseph form, which stays positive for any gain. About 1 us per sighting.
class ExtendedKalman final : public KalmanLocalizer {
 public:
  ExtendedKalman(const PoseEstimate& start, LandmarkWindow map, FeatureScales scales,
                 IdentificationOptions identification = {}, KalmanOptions options = {});
  void move(const BodyMotion& motion) override { estimate_ = moved(estimate_, motion); }
  PoseEstimate estimate() const override { return estimate_; }

 private:
  void update(const std::vector<Use>& uses, const Pose2& robot_from_sensor) override;
  void replace(const PoseEstimate& estimate) override { estimate_ = estimate; }
  void widen(double factor) override;
  PoseEstimate estimate_;
};

/// Standard deviations a lost filter may have: beyond 10 km and half a turn they say nothing more.
Eigen::Vector3d widest(const Eigen::Vector3d& sd);

/// One update of an EKF by one sighting, Joseph form. `trust` as in KalmanOptions.
PoseEstimate kalman_updated(const PoseEstimate& estimate, const SeenLandmark& seen,
                            const Pose2& robot_from_sensor, const MapLandmark& landmark, double trust = 1);

/// One step and one update of the unscented filter below, for who keeps covariances.
PoseEstimate unscented_moved(const PoseEstimate& estimate, const BodyMotion& motion);
PoseEstimate unscented_updated(const PoseEstimate& estimate, const SeenLandmark& seen,
                               const Pose2& robot_from_sensor, const MapLandmark& landmark, double trust = 1);

/// Unscented filter with the symmetric points of Arasaratnam & Haykin (2009, "cubature"), which have positive
/// weights, in square-root form: the covariance cannot become negative. Angles are averaged on the circle.
class UnscentedKalman final : public KalmanLocalizer {
 public:
  UnscentedKalman(const PoseEstimate& start, LandmarkWindow map, FeatureScales scales,
                  IdentificationOptions identification = {}, KalmanOptions options = {});
  void move(const BodyMotion& motion) override;
  PoseEstimate estimate() const override { return {pose_, root_ * root_.transpose()}; }

 private:
  void update(const std::vector<Use>& uses, const Pose2& robot_from_sensor) override;
  void replace(const PoseEstimate& estimate) override;
  void widen(double factor) override;
  Pose2 pose_;
  Eigen::Matrix3d root_;  ///< lower triangular
};

}  // namespace waymark
