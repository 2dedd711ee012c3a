// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>
#include "localization/identification/identification.hpp"
namespace waymark {

/// How particles are weighed.
struct WeightOptions {
  /// `likelihood`: log of the probability of what was seen. `paper`: eqs. 12-14.
  std::string weights = "likelihood";
  double clutter = 0.003;  ///< `likelihood`: density of false sightings, per metre of range and radian
  /// `likelihood`: power of each sighting's probability, (0, 1]; below 1 for sightings whose errors are not
  /// independent of the last ones.
  double temper = 0.5;
  double quality_floor = 0.1;  ///< qualities below count as this; 1: quality is not used
  /// `likelihood`: landmarks in view that were not seen speak against a pose, by log(1 - q detection).
  bool expect_unseen = false;
  double detection = 0.7;                 ///< probability that a landmark of quality 1 in view is seen
  double view_range = 20;                 ///< m: how far the sensor sees landmarks
  double view_angle = 6.283185307179586;  ///< rad: its whole field of view about its x axis
  double gate = 0.9999;                   ///< beyond it a landmark cannot be the one seen
  /// `paper`: what a sighting without a landmark adds to eq. 12; negative: the gate. 0 is the paper's letter,
  /// with which a particle that matches nothing is the best of all.
  double unmatched_cost = -1;
  double feature_tolerance = 0.15;
  double feature_limit = 9;
  double bearing_reach = 100;  ///< m

  void describe(OptionVisitor& option);
};

/// Weighs poses by one set of sightings. Made once per set, then asked for each particle from any thread:
/// about 60 ns per sighting where the map holds a few landmarks inside the gate, whatever its size.
class SightingScore {
 public:
  /// `map` and `scales` must outlive it. Unsound sightings are left out.
  SightingScore(const SightingSet& seen, const LandmarkGrid& map, const FeatureScales& scales,
                const WeightOptions& options, bool use_identities);

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
  struct Prepared {
    SeenLandmark seen;
    double cosine, sine;  ///< of the bearing
    double range_variance, bearing_variance;
    double radius;       ///< m about the expected place; about the sensor where there is no range
    double log_clutter;  ///< ln of the density where no landmark fits
    double gate;
    std::optional<std::uint32_t> landmark;  ///< of a known identity
    bool absent = false;                    ///< a known identity the map does not have
  };
  struct Best {
    double cost;
    std::uint32_t landmark;
  };
  Best best(const Prepared& p, const Eigen::Vector2d& sensor, double cosine, double sine) const;
  double log_unseen(std::uint32_t landmark) const;
  double unseen(const Eigen::Vector2d& sensor, double cosine, double sine,
                std::span<const std::uint32_t> matched) const;
  double pair(const Prepared& p, std::uint32_t landmark, const Eigen::Vector2d& sensor,
              const Eigen::Vector2d& along) const;

  const LandmarkGrid* map_;
  const FeatureScales* scales_;
  WeightOptions options_;
  Pose2 robot_from_sensor_;
  std::vector<Prepared> prepared_;
  bool paper_;
  std::vector<std::uint32_t> hidden_;
  std::vector<TypeId> types_;  // that the sensor sees, as far as this set tells
};

/// Weights of eqs. 13-14 from errors: (e_max - e) / e_max. Degenerate cases: all errors equal (also all 0, or
/// e_max = 0) says nothing, every weight is 1.
std::vector<double> paper_weights(std::span<const double> errors);

/// exp(log weight), scaled so that they sum to 1. Where none is above -infinity all are equal.
std::vector<double> normalised(std::span<const double> log_weights);

}  // namespace waymark
