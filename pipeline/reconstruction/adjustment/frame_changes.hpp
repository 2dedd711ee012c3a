// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "pipeline/reconstruction/adjustment/network.hpp"
namespace waymark::pipeline {

/// Returns the changes of the network that no observation sees, one per column, for all unknowns that are not
/// points: the frame's translation, rotation and scale as far as they are free. Marks never see them, nor do
/// expected motions, so only the other terms are examined; a freedom counts as fixed from 1e-5 of the
/// accuracy of the best.
Eigen::MatrixXd free_frame_changes(const Network& network);

/// Returns the weights of the unknowns that are not points in the inner constraints: 1 for centres, the mean
/// square distance of the cameras from their mean for rotations, 0 for lenses and the bias.
Eigen::VectorXd inner_constraint_weights(const Network& network);

}  // namespace waymark::pipeline
