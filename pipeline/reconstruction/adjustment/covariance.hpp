// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
#include "pipeline/reconstruction/adjustment/network.hpp"
namespace waymark::pipeline {

/// Covariance of a solved network for a standard deviation of unit weight of 1.
struct NetworkCovariance {
  bool determined = false;  ///< false: more than the frame is undetermined, and there are no values
  int free_datum = 0;       ///< freedoms of the frame fixed by inner constraints
  Eigen::MatrixXd cameras;  ///< of all unknowns that are not points, by `Block::column`
  /// Of points by block, with zeros for fixed components; none for points at infinity.
  std::vector<std::optional<Eigen::Matrix3d>> points;
};

/// Computes the covariance by the dense inverse of the normal matrix reduced by the points, then those of the
/// points. A free frame is fixed by inner constraints on the cameras (Meissl 1969): weighted by
/// inner_constraint_weights(), their changes have no component along free_frame_changes().
NetworkCovariance covariance(const Network& network);

/// Returns the covariance of a point, given that of the unknowns that are not points.
std::optional<Eigen::Matrix3d> point_covariance(const Network& network, std::size_t block,
                                                const Eigen::MatrixXd& cameras);

}  // namespace waymark::pipeline
