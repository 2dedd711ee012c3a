// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/triangulate.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "core/solve.hpp"
#include "pipeline/reconstruction/adjustment/lens_model.hpp"
#include "pipeline/reconstruction/adjustment/shutter_motion.hpp"

namespace waymark::pipeline {
namespace {

struct WorldRay {
  Eigen::Vector3d origin, unit;
};

// Point of least squared distance to the rays.
std::optional<Eigen::Vector3d> midpoint(const std::vector<WorldRay>& rays) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  const Eigen::Vector3d base = rays.front().origin;
  for (const WorldRay& r : rays) {
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - r.unit * r.unit.transpose();
    sum += across;
    right += across * (r.origin - base);
  }
  constexpr double kParallel = 1e-14;  // squared angle of 1e-7 radians
  if (!(sum.determinant() > kParallel * static_cast<double>(rays.size()))) return std::nullopt;
  return base + solve_symmetric(sum, right);
}

double largest_angle(const std::vector<WorldRay>& rays) {
  double largest = 0;
  for (std::size_t i = 0; i < rays.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      largest = std::max(largest,
                         std::atan2(rays[i].unit.cross(rays[j].unit).norm(), rays[i].unit.dot(rays[j].unit)));
  return largest;
}

struct Fit {
  double squares = 0;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
};

std::optional<Fit> fit_at(std::span<const PosedMark> marks, const Eigen::Vector3d& point,
                          const std::vector<std::shared_ptr<const LensModel>>& lenses,
                          const std::vector<Eigen::VectorXd>& parameters) {
  Fit fit;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const PosedMark& mark = marks[i];
    const Eigen::Matrix3d turn = mark.world_from_camera.linear().transpose();
    LensModel::Residual seen;
    if (!lenses[i]->residual(parameters[i], turn * (point - mark.world_from_camera.translation()), mark.pixel,
                             seen))
      return std::nullopt;
    const Eigen::Matrix<double, 2, 3> by_world = seen.by_point * turn / mark.sd;
    const Eigen::Vector2d residual = seen.value / mark.sd;
    fit.squares += residual.squaredNorm();
    fit.normal += by_world.transpose() * by_world;
    fit.right += by_world.transpose() * residual;
  }
  return fit;
}

}  // namespace

std::optional<TriangulatedPoint> triangulate(std::span<const PosedMark> marks) {
  std::vector<WorldRay> rays;
  std::vector<std::shared_ptr<const LensModel>> lenses;
  std::vector<Eigen::VectorXd> parameters;
  for (const PosedMark& mark : marks) {
    const auto along = ray(*mark.camera, mark.pixel);
    if (!along) return std::nullopt;
    rays.push_back({mark.world_from_camera.translation(), mark.world_from_camera.linear() * along->unit});
    lenses.push_back(lens_model(*mark.camera));
    parameters.push_back(lenses.back()->parameters(*mark.camera));
  }
  if (rays.size() < 2) return std::nullopt;
  const auto start = midpoint(rays);
  if (!start) return std::nullopt;
  TriangulatedPoint found{.position = *start};
  auto fit = fit_at(marks, found.position, lenses, parameters);
  for (int step = 0; step < 20 && fit; ++step) {
    Eigen::Vector3d move = solve_symmetric(fit->normal, fit->right);
    if (!move.allFinite()) return std::nullopt;
    bool better = false;
    for (int halving = 0; halving < 10 && !better; ++halving, move /= 2) {
      const auto next = fit_at(marks, found.position - move, lenses, parameters);
      if (!next || !(next->squares < fit->squares)) continue;
      better = true;
      found.position -= move;
      fit = next;
    }
    if (!better) break;
  }
  if (!fit) return std::nullopt;
  found.covariance = fit->normal.inverse();
  found.angle = largest_angle(rays);
  found.rms = std::sqrt(fit->squares / static_cast<double>(2 * marks.size()));
  return found.covariance.allFinite() ? std::optional(found) : std::nullopt;
}

std::optional<TriangulatedPoint> triangulate(const Reconstruction& scene, const std::vector<Mark>& marks) {
  std::vector<PosedMark> posed;
  for (const Mark& mark : marks) {
    const AdjustedImage& image = scene.images.at(mark.image);
    if (image.world_from_camera)
      posed.push_back({&scene.lenses.at(image.lens).camera, pose_of_mark(scene, mark), mark.pixel, mark.sd});
  }
  return triangulate(posed);
}

}  // namespace waymark::pipeline
