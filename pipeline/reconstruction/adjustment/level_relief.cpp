// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/level_relief.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/solve.hpp"

namespace waymark::pipeline {
namespace {

/// Direction across the points, towards the cameras: of the smallest spread, then of a robust plane.
Eigen::Vector3d normal_of(const ReliefToPlace& relief) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero(), cameras = mean;
  for (const Eigen::Vector3d& p : relief.points) mean += p / double(relief.points.size());
  for (const Eigen::Vector3d& c : relief.centres) cameras += c / double(relief.centres.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : relief.points) spread += (p - mean) * (p - mean).transpose();
  Eigen::Vector3d normal = symmetric_eigen(spread).vectors.col(0);
  if (normal.dot(cameras - mean) < 0) normal = -normal;
  const Eigen::Matrix3d level = rotation_between(normal, Eigen::Vector3d::UnitZ());
  std::vector<Eigen::Vector3d> turned;
  for (const Eigen::Vector3d& p : relief.points) turned.push_back(level * (p - mean));
  const Eigen::Vector3d plane = fitted_plane(std::move(turned));
  return level.transpose() * Eigen::Vector3d(-plane.x(), -plane.y(), 1).normalized();
}

}  // namespace

Eigen::Vector3d fitted_plane(std::vector<Eigen::Vector3d> points) {
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();
  for (int round = 0; round < 3; ++round) {
    Eigen::MatrixXd a(static_cast<Eigen::Index>(points.size()), 3);
    Eigen::VectorXd z(a.rows());
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      const Eigen::Vector3d& p = points[static_cast<std::size_t>(i)];
      a.row(i) << p.x(), p.y(), 1;
      z[i] = p.z();
    }
    plane = solve_least_squares(a, z);
    std::ranges::sort(points, {}, [&](const Eigen::Vector3d& p) {
      return std::abs(p.z() - plane.dot(Eigen::Vector3d(p.x(), p.y(), 1)));
    });
    points.resize(std::max<std::size_t>(3, points.size() * 9 / 10));
  }
  return plane;
}

LevelRelief level_relief(const ReliefToPlace& relief) {
  LevelRelief out;
  Similarity& to = out.level_from_frame;
  to.rotation =
      rotation_between(relief.up ? relief.up->normalized() : normal_of(relief), Eigen::Vector3d::UnitZ());
  std::vector<double> x, y, z;
  for (const Eigen::Vector3d& p : relief.points) {
    const Eigen::Vector3d at = to.rotation * p;
    x.push_back(at.x()), y.push_back(at.y()), z.push_back(at.z());
  }
  const auto range = [](std::vector<double> values) {  // without the outermost hundredth
    std::ranges::sort(values);
    return std::pair(values[values.size() / 100], values[values.size() - 1 - values.size() / 100]);
  };
  const auto [west, east] = range(x);
  const auto [south, north] = range(y);
  const double extent = std::max(east - west, north - south);
  if (!(extent > 0)) return out;
  to.scale = 1 / extent;
  std::ranges::sort(z);
  to.shift = -to.scale * Eigen::Vector3d((west + east) / 2, (south + north) / 2, z[z.size() / 2]);
  std::map<std::pair<int, int>, std::vector<Eigen::Vector3d>> bins;
  for (const Eigen::Vector3d& p : relief.points) {
    const Eigen::Vector3d at = to * p;
    if (std::abs(at.x()) <= 0.5 && std::abs(at.y()) <= 0.5)
      bins[{int(std::floor(at.x() * kReliefBins)), int(std::floor(at.y() * kReliefBins))}].push_back(at);
  }
  for (auto& [bin, points] : bins) {
    std::ranges::sort(points, {}, [](const Eigen::Vector3d& p) { return p.z(); });
    out.nodes.push_back(points[points.size() / 2]);
  }
  if (out.nodes.size() < kMinReliefNodes) return out;
  const Eigen::Vector3d plane = fitted_plane(out.nodes);
  double squares = 0;
  for (const Eigen::Vector3d& p : out.nodes)
    squares += std::pow(p.z() - plane.dot(Eigen::Vector3d(p.x(), p.y(), 1)), 2);
  out.relief = std::sqrt(squares / double(out.nodes.size()));
  return out;
}

}  // namespace waymark::pipeline
