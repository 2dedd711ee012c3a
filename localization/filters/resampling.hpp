// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>
#include "core/random.hpp"
#include "localization/pose2.hpp"
namespace waymark::localization {

/// Returns the effective sample size, 1 / sum of squared weights. Weights sum to 1.
double effective_sample_size(std::span<const double> weights);

/// Draws indices of `count` particles by systematic resampling (Kitagawa 1996) with one random number u in
/// [0, 1). Each index is drawn within one of its expected number. Weights sum to 1.
std::vector<std::uint32_t> resample(std::span<const double> weights, std::size_t count, double u);

/// Returns mean and covariance of all weighted poses. Headings within a right angle of the first one's are
/// averaged directly, others by their unit vectors.
PoseEstimate moments(std::span<const Pose2> poses, std::span<const double> weights);

/// Resamples and regularizes: each drawn pose is shrunk towards the mean and blurred by a kernel (Liu &
/// West 2001, width by Silverman's rule). This keeps mean and covariance, `all`. Only for one mode: between
/// two it would fill the gap.
std::vector<Pose2> resample_regularized(std::span<const Pose2> poses, std::span<const double> weights,
                                        const PoseEstimate& all, std::size_t count, Random& random);

/// Returns the number of particles that keeps the Kullback-Leibler error of their histogram below `error`
/// with probability 0.99, given the number of occupied bins (Fox 2003, eq. 7).
std::size_t kld_count(std::size_t bins, double error);

/// Returns the number of bins of metres x metres x radians that poses occupy.
std::size_t occupied_bins(std::span<const Pose2> poses, double metres, double radians);

/// Returns mean and covariance of the densest mode if it holds most of the weight within `radius` metres,
/// otherwise of all poses. Thus a few outlying particles do not shift the estimate.
PoseEstimate dominant_mode(std::span<const Pose2> poses, std::span<const double> weights, double radius);

}  // namespace waymark::localization
