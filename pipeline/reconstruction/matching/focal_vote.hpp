// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>
namespace waymark::pipeline {

/// A fundamental matrix about the middles of two images of one lens, and its weight in the vote.
struct FocalEvidence {
  Eigen::Matrix3d fundamental = Eigen::Matrix3d::Zero();
  double weight = 1;  ///< number of matches that agree
};

/// Estimates the focal length in pixels that makes the matrices essential: both singular values equal
/// (Mendonca & Cipolla 1999). Searches between `low` and `high`; each pair votes with a bounded cost.
/// `std::nullopt` without a clear minimum, as for planes, parallel axes and forward motion.
std::optional<double> vote_focal_length(std::span<const FocalEvidence> evidence, double low, double high);

}  // namespace waymark::pipeline
