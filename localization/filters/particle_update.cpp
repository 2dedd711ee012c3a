// SPDX-License-Identifier: Apache-2.0
// Update of the particles by a set of sightings.
#include <algorithm>

#include "localization/filters/particle_blocks.hpp"
#include "localization/filters/particle_filter.hpp"
#include "localization/filters/particle_weights.hpp"
#include "localization/filters/resampling.hpp"
#include "localization/filters/sighting_score.hpp"

namespace waymark::localization {
namespace {

using Values = Eigen::Map<const Eigen::ArrayXd>;

constexpr double kNearEnough = 2;    // m: spread below which occlusion is computed from the mean
constexpr double kOneHeading = 0.5;  // rad
constexpr int kMaxSteps = 20;        // tempered steps of one update

}  // namespace

void ParticleFilter::weigh(const SightingSet& seen, const LandmarkGrid& map) {
  SightingScore score(seen, map, matcher_.scales(), options_.weight, matcher_.options(),
                      [this](LandmarkKey key) { return map_error_factor(key); });
  if (score.sightings() == 0) return;
  // Computes occlusion from the mean. During a search there is none, and all landmarks are expected.
  const double spread = std::sqrt(summary_.covariance(0, 0) + summary_.covariance(1, 1));
  if (visible_ && options_.weight.expect_unseen && spread < kNearEnough)
    score.hide(hidden_landmarks(summary_.pose * seen.robot_from_sensor, map,
                                options_.weight.view_range + spread, visible_));
  std::vector<double> fit(poses_.size());
  const auto ask = [&] {
    score.prefetch(poses_);
    for_each_block(poses_.size(), options_.threads, [&](std::size_t first, std::size_t last) {
      score(std::span(poses_).subspan(first, last - first), std::span(fit).subspan(first, last - first));
    });
  };
  ask();
  if (options_.weight.weights == "paper") {
    const std::vector<double> factor = paper_weights(fit);
    for (std::size_t i = 0; i < fit.size(); ++i) fit[i] = std::log(weights_[i]) + std::log(factor[i]);
    weights_ = normalise_log_weights(fit);
    return;
  }
  const Values fits(fit.data(), std::ssize(fit)), weights(weights_.data(), std::ssize(weights_));
  // Mean likelihood per sighting.
  const double mean = (weights * (fits / static_cast<double>(score.sightings())).exp()).sum();
  slow_ += (slow_ == 0 ? 1 : options_.recovery_slow) * (mean - slow_);
  fast_ += (fast_ == 0 ? 1 : options_.recovery_fast) * (mean - fast_);

  const double min_size = options_.resample_below * static_cast<double>(poses_.size());
  Random random(static_cast<std::uint64_t>(options_.seed) + step_, "parts");
  double left = 1;
  PoseEstimate cloud = moments(poses_, weights_);
  for (int i = 0; i < kMaxSteps && is_unimodal(cloud); ++i) {
    TemperedWeights tempered = temper_weights(weights_, fit, left, min_size);
    weights_ = std::move(tempered.weights);
    left -= tempered.exponent;
    if (!(left > 0)) return;
    cloud = moments(poses_, weights_);
    poses_ = resample_regularized(poses_, weights_, cloud, poses_.size(), random);
    weights_.assign(poses_.size(), 1 / static_cast<double>(poses_.size()));
    ask();
  }
  for (std::size_t i = 0; i < fit.size(); ++i) fit[i] = left * fit[i] + std::log(weights_[i]);
  weights_ = normalise_log_weights(fit);
}

bool ParticleFilter::is_unimodal(const PoseEstimate& cloud) const {
  const Eigen::Matrix3d& c = cloud.covariance;
  return !searching_ && c(0, 0) + c(1, 1) < kModeRadius * kModeRadius && c(2, 2) < kOneHeading * kOneHeading;
}

std::size_t ParticleFilter::required_count() const {
  const auto max_count =
      static_cast<std::size_t>(searching_ ? options_.search_particles : options_.particles);
  if (!options_.adaptive) return max_count;
  const std::size_t needed = kld_count(occupied_bins(poses_, 0.25, 0.17), options_.kld_error);
  return std::clamp<std::size_t>(needed, 50, static_cast<std::size_t>(options_.search_particles));
}

void ParticleFilter::resample_particles(const SightingSet& seen, const LandmarkGrid& map) {
  Random random(static_cast<std::uint64_t>(options_.seed) + step_, "draw");
  const std::size_t count = required_count();
  std::vector<Pose2> next;
  if (const PoseEstimate cloud = moments(poses_, weights_); is_unimodal(cloud)) {
    next = resample_regularized(poses_, weights_, cloud, count, random);
  } else {
    for (const std::uint32_t i : resample(weights_, count, random.uniform())) next.push_back(poses_[i]);
  }
  // Draws new poses if the likelihood falls to half its long-term mean (Gutmann & Fox 2002).
  const double fresh = options_.recovery && slow_ > 0 ? std::clamp(1 - 2 * fast_ / slow_, 0.0, 0.2) : 0;
  // A pose that explains one sighting is right once in as many tries as there are landmarks.
  const bool sensible = !finder_samples_.empty() || map.size() <= count;
  if (fresh > 0.02 && sensible)
    for (Pose2& p : next)
      if (random.bernoulli(fresh)) p = sample_pose(seen, map, random).value_or(p);
  poses_ = std::move(next);
  weights_.assign(poses_.size(), 1 / static_cast<double>(poses_.size()));
}

}  // namespace waymark::localization
