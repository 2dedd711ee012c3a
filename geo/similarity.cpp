// SPDX-License-Identifier: Apache-2.0
#include "geo/similarity.hpp"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <cmath>

#include "core/error.hpp"
#include "core/solve.hpp"

namespace waymark::inline geo {
namespace {

Eigen::Matrix3Xd columns_of(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) columns.col(static_cast<Eigen::Index>(i)) = points[i];
  return columns;
}

// Returns the spread of the points across their longest direction, as a fraction of it.
double width_fraction(const Eigen::Matrix3Xd& points) {
  const Eigen::Matrix3Xd about = points.colwise() - points.rowwise().mean();
  const Eigen::Vector3d spread = singular_values(about * about.transpose()).values;
  return spread[0] > 0 ? std::sqrt(spread[1] / spread[0]) : 0;
}

}  // namespace

Similarity estimate_similarity(const std::vector<Eigen::Vector3d>& frame,
                               const std::vector<Eigen::Vector3d>& map) {
  if (frame.size() != map.size() || frame.size() < 3)
    throw Error(
        ErrorCode::input,
        fmt::format("{} control points: a similarity needs 3 or more", std::min(frame.size(), map.size())),
        "", "measure more points, wide apart");
  const Eigen::Matrix3Xd from = columns_of(frame), to = columns_of(map);
  constexpr double kLine = 1e-3;
  if (!from.allFinite() || !to.allFinite() || !(width_fraction(from) > kLine) ||
      !(width_fraction(to) > kLine))
    throw Error(ErrorCode::input, "the control points lie on one line: the rotation about it is unknown", "",
                "add points beside the line");
  // About the means, so that seven-digit coordinates lose nothing.
  const Eigen::Vector3d from_mean = from.rowwise().mean(), to_mean = to.rowwise().mean();
  const Eigen::Matrix4d fit = Eigen::umeyama(Eigen::Matrix3Xd(from.colwise() - from_mean),
                                             Eigen::Matrix3Xd(to.colwise() - to_mean), true);
  Similarity found;
  found.scale = fit.block<3, 1>(0, 0).norm();
  found.rotation = fit.topLeftCorner<3, 3>() / found.scale;
  found.shift = to_mean + fit.block<3, 1>(0, 3) - found.scale * (found.rotation * from_mean);
  return found;
}

double residual(const Similarity& similarity, const std::vector<Eigen::Vector3d>& frame,
                const std::vector<Eigen::Vector3d>& map) {
  double sum = 0;
  for (std::size_t i = 0; i < frame.size(); ++i) sum += (similarity * frame[i] - map[i]).squaredNorm();
  return frame.empty() ? 0 : std::sqrt(sum / static_cast<double>(frame.size()));
}

}  // namespace waymark::inline geo
