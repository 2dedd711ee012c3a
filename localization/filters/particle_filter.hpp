// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <unordered_map>
#include "core/random.hpp"
#include "localization/filters/cloud_covariance.hpp"
#include "localization/filters/convergence.hpp"
#include "localization/filters/particle_weights.hpp"
#include "localization/global/pose_finder.hpp"
#include "localization/global/sighting_memory.hpp"
#include "localization/identification/landmark_matcher.hpp"
#include "localization/line_of_sight.hpp"
#include "localization/localizer.hpp"
namespace waymark::localization {

/// Options of the particle filter.
struct ParticleOptions {
  std::int64_t particles = 500;          ///< while the pose is known
  std::int64_t search_particles = 4000;  ///< during global localization
  bool adaptive = false;                 ///< KLD sampling: as many as the spread needs, up to the above
  double kld_error = 0.05;               ///< error bound of KLD sampling
  double resample_below = 0.5;           ///< fraction of the particles that must be effective
  bool recovery = true;                  ///< augmented filter: random particles when the likelihood falls
  double recovery_slow = 0.005;          ///< decay of the long-term mean likelihood, per set of sightings
  double recovery_fast = 0.05;
  std::int64_t seed = 1;
  std::int64_t threads = 0;  ///< 0: as many as there are; no effect on the result
  WeightOptions weight;

  void describe(OptionVisitor& option);
};

/// Particle filter (section 4.2): Monte Carlo localization (Thrun et al. 2005) with augmented recovery and
/// KLD sampling. The same seed gives the same track for any number of threads.
/// - A unimodal cloud is updated in tempered steps and resampled after each (progressive correction and
///   regularization, Musso et al. 2001). This keeps a precise set from leaving a handful of particles.
/// - During a search, poses are sampled where a landmark of the right type explains a sighting. Half of
///   them come from the PoseFinder, if there is one, applied to recent sightings. In a map with more
///   than a tenth as many landmarks there are none before the finder is certain: they would miss the robot.
/// - Without a start, the robot is found when the PoseFinder is certain (Convergence).
class ParticleFilter final : public Localizer {
 public:
  /// Without a start the first sightings initialise the filter.
  ParticleFilter(std::optional<PoseEstimate> start, LandmarkMatcher matcher, ParticleOptions options = {},
                 PoseFinder finder = {});
  void predict(const BodyMotion& motion) override;
  /// Returns the verdicts of `identify` at the estimate after the update.
  std::vector<Match> update(const SightingSet& seen) override;
  bool fix(const GnssFix& gnss) override;
  bool fix(const HeadingFix& heading) override;
  PoseEstimate estimate() const override { return now({summary_.pose, real_.covariance()}); }
  PoseEstimate assumed_estimate() const override { return now(summary_); }
  LocalizationStatus status() const override;

  /// Sets the line-of-sight test. With `expect_unseen`, hidden landmarks are not expected.
  void set_line_of_sight(LineOfSight visible) { visible_ = std::move(visible); }

  std::size_t particles() const { return poses_.size(); }

 private:
  PoseEstimate now(const PoseEstimate& at_update) const {
    const PoseEstimate moved = predict_pose(at_update, pending_);
    return convergence_ ? convergence_->inflate_covariance(moved) : moved;
  }
  static constexpr double kModeRadius = 1.5;  // m: particles nearer than this are one hypothesis

  void apply_motion();  // moves the particles by the motion since the last call
  void weigh(const SightingSet& seen, const LandmarkGrid& map);
  void follow_sightings(const PoseEstimate& before, const SightingSet& seen,
                        const std::vector<Match>& matches, const LandmarkGrid& map);
  bool is_unimodal(const PoseEstimate& cloud) const;  // whether the particles are one cloud
  void resample_particles(const SightingSet& seen, const LandmarkGrid& map);
  std::optional<Pose2> sample_pose(const SightingSet& seen, const LandmarkGrid& map, Random& random) const;
  void query_finder(const SightingSet& seen);
  void sample_found(const PoseEstimate& at);
  void sample_around_fix(const GnssFix& gnss, double kept);
  template <class Fit>
  bool reweight(Fit&& fit);
  bool can_search(const LandmarkGrid& map) const;
  void search(const SightingSet& seen, const LandmarkGrid& map, std::size_t count);
  std::size_t required_count() const;
  /// Returns the factor on the map variance of a landmark: 1 plus its recent sightings, which had the same
  /// error.
  double map_error_factor(LandmarkKey key) const;

  LandmarkMatcher matcher_;
  ParticleOptions options_;
  std::vector<Pose2> poses_;
  std::vector<double> weights_;  // sum to 1
  BodyMotion pending_;
  PoseEstimate summary_;  // of the particles
  CloudCovariance real_;  // of the errors of its pose
  std::uint64_t step_ = 0;
  double slow_ = 0, fast_ = 0;
  bool searching_ = false;
  PoseFinder finder_;
  SightingMemory memory_;
  std::vector<Pose2> finder_samples_;  // samples of the poses that the finder returned
  std::uint64_t queried_set_ = 0;      // set at which the finder was called last
  std::uint64_t sets_ = 0;
  double found_sd_ = 0;  // m, of the last pose the finder accepted: a search gets no closer by itself
  FixGate gnss_;
  int contested_ = 0;  // fixes to ignore until sightings decide between them and the particles
  std::optional<Convergence> convergence_;  // only without a given start
  ChanceFraction chance_;
  LineOfSight visible_;
  struct LandmarkUse {
    double count = 0, driven = 0;  // sightings, and the distance driven at the last one
  };
  std::unordered_map<LandmarkKey, LandmarkUse> uses_;
  double driven_ = 0;
};

}  // namespace waymark::localization
