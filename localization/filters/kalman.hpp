// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "localization/filters/map_errors.hpp"
#include "localization/identification/landmark_matcher.hpp"
#include "localization/localizer.hpp"
namespace waymark::localization {

/// Options of the extended and the unscented Kalman filter.
struct KalmanOptions {
  std::int64_t lost_after = 10;        ///< consecutive sets without a match before the search begins
  double search_growth = 2;            ///< growth of the standard deviations per further set; 1: no search
  double error_memory_distance = 200;  ///< m: memory of MapErrors; described by MultiHypothesisOptions

  void describe(OptionVisitor& option);
};

/// Base of the extended and the unscented filter: data association, gates and recovery. A filter that
/// rejects all sightings of `lost_after` sets is lost and widens its covariance until something fits.
/// Without this a gate that is too tight would reject for ever.
class KalmanLocalizer : public Localizer {
 public:
  KalmanLocalizer(LandmarkMatcher matcher, KalmanOptions options);
  std::vector<Match> update(const SightingSet& seen) final;
  bool fix(const GnssFix& gnss) final { return apply_fix(gnss, 2); }
  bool fix(const HeadingFix& heading) final { return apply_fix(heading, 1); }
  LocalizationStatus status() const final {
    return missed_ >= options_.lost_after ? LocalizationStatus::lost : LocalizationStatus::tracking;
  }

 protected:
  /// A sighting, its landmark, and the divisor of the noise, (0, 1].
  struct MatchedSighting {
    const SeenLandmark* seen = nullptr;
    const MapLandmark* landmark = nullptr;
    double trust = 1;
    double probability = 1;  ///< that it shows the landmark
  };
  virtual void correct(const std::vector<MatchedSighting>& uses, const Pose2& robot_from_sensor) = 0;
  virtual void replace(const PoseEstimate& estimate) = 0;
  virtual void widen(double factor) = 0;

 private:
  /// Corrects the estimate by the angles of a matched sighting, which measure the heading.
  void correct_heading(const SeenLandmark& seen, const Pose2& robot_from_sensor, const MapLandmark& landmark);
  template <class Fix>
  bool apply_fix(const Fix& measured, int rows);

  LandmarkMatcher matcher_;
  KalmanOptions options_;
  std::int64_t missed_ = 0;
  FixGate gnss_, heading_;
};

/// Extended Kalman filter (eqs. 15-16). Departures: x and P on the right-hand side are the predicted ones;
/// the covariance is updated in Joseph form, which stays positive for any gain. About 1 us per sighting.
class ExtendedKalman final : public KalmanLocalizer {
 public:
  ExtendedKalman(const PoseEstimate& start, LandmarkMatcher matcher, KalmanOptions options = {});
  void predict(const BodyMotion& motion) override;
  PoseEstimate estimate() const override { return estimate_; }

 private:
  void correct(const std::vector<MatchedSighting>& uses, const Pose2& robot_from_sensor) override;
  void replace(const PoseEstimate& estimate) override;
  void widen(double factor) override;
  PoseEstimate estimate_;
  MapErrors errors_;
};

/// Clamps the standard deviations of a lost filter to at most 10 km and half a turn.
Eigen::Vector3d clamp_sd(const Eigen::Vector3d& sd);

/// Returns the EKF update by one sighting, Joseph form. `trust` in (0, 1] divides the noise.
PoseEstimate ekf_update(const PoseEstimate& estimate, const SeenLandmark& seen,
                        const Pose2& robot_from_sensor, const MapLandmark& landmark, double trust = 1);

/// Predicts as the unscented filter below, on covariances.
PoseEstimate ukf_predict(const PoseEstimate& estimate, const BodyMotion& motion);

/// Unscented filter with the symmetric points of Arasaratnam & Haykin (2009, "cubature"), which have
/// positive weights. Predictions are in square-root form; updates are linear regressions over the points, in
/// Joseph form (MapErrors). The covariance cannot become negative. Angles are averaged on the circle.
class UnscentedKalman final : public KalmanLocalizer {
 public:
  UnscentedKalman(const PoseEstimate& start, LandmarkMatcher matcher, KalmanOptions options = {});
  void predict(const BodyMotion& motion) override;
  PoseEstimate estimate() const override { return {pose_, root_ * root_.transpose()}; }

 private:
  void correct(const std::vector<MatchedSighting>& uses, const Pose2& robot_from_sensor) override;
  void replace(const PoseEstimate& estimate) override;
  void widen(double factor) override;
  Pose2 pose_;
  Eigen::Matrix3d root_;  ///< lower triangular
  MapErrors errors_;
};

}  // namespace waymark::localization
