// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>
#include "core/random.hpp"
#include "localization/pose2.hpp"
namespace waymark {

/// 1 / sum of squared weights: as many equal particles would say as much. Weights sum to 1.
double effective_count(std::span<const double> weights);

/// Systematic resampling (Kitagawa 1996): indices of `count` particles drawn with one random number u in
/// [0, 1). Each is drawn within one of its expected number. Weights sum to 1.
std::vector<std::uint32_t> resample(std::span<const double> weights, std::size_t count, double u);

/// Mean and covariance of all weighted poses. Headings that all lie within a right angle of the first one's
/// are averaged as they are, others by their vectors.
PoseEstimate moments(std::span<const Pose2> poses, std::span<const double> weights);

/// As many poses drawn by weight, each moved a little, so that copies of few survivors are a cloud again:
/// shrunk towards the mean and blurred by a kernel (Liu & West 2001, width by Silverman's rule), which keeps
/// mean and covariance, `all`: the moments. For particles that lie together: between two places it would fill
/// the gap.
std::vector<Pose2> redraw(std::span<const Pose2> poses, std::span<const double> weights,
                          const PoseEstimate& all, std::size_t count, Random& random);

/// Particles needed so that the error of their histogram (Kullback-Leibler distance) stays below `error` with
/// probability 0.99, given the number of bins they occupy (Fox 2003, eq. 7).
std::size_t kld_count(std::size_t bins, double error);

/// Bins of metres x metres x radians that poses occupy.
std::size_t occupied_bins(std::span<const Pose2> poses, double metres, double radians);

/// Mean and covariance of weighted poses: of the densest part where most of the weight lies together (within
/// `radius` metres), so that a few lost particles do not pull the robot off its place; of all otherwise.
PoseEstimate summary(std::span<const Pose2> poses, std::span<const double> weights, double radius);

}  // namespace waymark
