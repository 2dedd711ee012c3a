// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "core/random.hpp"
#include "localization/filters/convergence.hpp"
#include "localization/filters/sighting_score.hpp"
#include "localization/global/pose_finder.hpp"
#include "localization/global/sighting_memory.hpp"
#include "localization/identification/landmark_window.hpp"
#include "localization/line_of_sight.hpp"
#include "localization/localizer.hpp"
namespace waymark {

struct ParticleOptions {
  std::int64_t particles = 500;          ///< while the place is known
  std::int64_t search_particles = 4000;  ///< while it is not
  bool adaptive = false;                 ///< KLD sampling: as many as the spread needs, up to the above
  double kld_error = 0.05;               ///< of the adaptive number
  double resample_below = 0.5;           ///< part of the particles that must be effective
  bool recovery = true;                  ///< augmented filter: new particles when sightings fit ever less
  double recovery_slow = 0.005;          ///< per set of sightings
  double recovery_fast = 0.05;
  std::int64_t seed = 1;
  std::int64_t threads = 0;  ///< 0: as many as there are; no effect on the result
  WeightOptions weight;

  void describe(OptionVisitor& option);
};

/// Particle filter (section 4.2; Monte Carlo localization, Thrun et al. 2005, with augmented recovery and KLD
/// sampling). Sightings that would leave a handful of the particles that lie together are believed part by
/// part, with a new cloud drawn after each (progressive correction and regularization, Musso et al. 2001).
/// The same seed gives the same track for any number of threads. Poses for the search are drawn where a
/// landmark of the right type explains one of the sightings, and half of them from a PoseFinder, if there is
/// one, which is asked about all that was seen lately.
class ParticleFilter final : public Localizer {
 public:
  /// Without a start the first sightings say where the robot may be.
  ParticleFilter(std::optional<PoseEstimate> start, LandmarkWindow map, FeatureScales scales,
                 IdentificationOptions identification = {}, ParticleOptions options = {},
                 PoseFinder finder = {});
  void move(const BodyMotion& motion) override;
  /// The verdicts are those of `identify` at the estimate after the update.
  std::vector<Match> see(const SightingSet& seen) override;
  bool fix(const GnssFix& gnss) override;
  bool fix(const HeadingFix& heading) override;
  PoseEstimate estimate() const override {
    return doubt_ ? doubt_->honest(moved(summary_, pending_)) : moved(summary_, pending_);
  }
  Trust trust() const override;

  /// With `expect_unseen`: what the ground hides is not expected.
  void look_over(LineOfSight visible) { visible_ = std::move(visible); }

  std::size_t particles() const { return poses_.size(); }

 private:
  static constexpr double kOnePlace = 1.5;  // m: particles nearer than this are one hypothesis

  void spread();  // moves the particles by what has been driven since the last time
  void weigh(const SightingSet& seen, const LandmarkGrid& map);
  bool together(const PoseEstimate& cloud) const;  // the particles are one cloud about one place
  void draw_again(const SightingSet& seen, const LandmarkGrid& map);
  std::optional<Pose2> pose_that_explains(const SightingSet& seen, const LandmarkGrid& map,
                                          Random& random) const;
  void ask_finder(const SightingSet& seen);
  void draw_about(const GnssFix& gnss, double kept);
  template <class Fit>
  bool weigh_by(Fit&& fit);
  void search(const SightingSet& seen, const LandmarkGrid& map, std::size_t count);
  std::size_t wanted() const;

  LandmarkWindow map_;
  FeatureScales scales_;
  IdentificationOptions identification_;
  ParticleOptions options_;
  std::vector<Pose2> poses_;
  std::vector<double> weights_;  // sum to 1
  BodyMotion pending_;
  PoseEstimate summary_;
  std::uint64_t step_ = 0;
  double slow_ = 0, fast_ = 0;
  bool searching_ = false;
  PoseFinder finder_;
  SightingMemory memory_;
  std::vector<Pose2> hints_;  // poses the finder gave, drawn with their covariances
  std::uint64_t asked_ = 0;   // set at which it was asked last
  std::uint64_t sets_ = 0;
  double found_sd_ = 0;  // m, of the last pose the finder was sure of: no search gets nearer by itself
  FixGate gnss_;
  int contested_ = 0;  // fixes that are left out until what is seen decides between them and the particles
  std::optional<Convergence> doubt_;  // where no start was given
  ChanceShare chance_;
  LineOfSight visible_;
};

}  // namespace waymark
