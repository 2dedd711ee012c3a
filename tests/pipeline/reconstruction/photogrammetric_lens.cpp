// SPDX-License-Identifier: Apache-2.0
#include "photogrammetric_lens.hpp"

#include <ceres/jet.h>

namespace waymark::test {
namespace {

// Corrects a mark from the upper left corner, y down, to millimetres from the principal point, y up.
template <class T>
std::array<T, 2> correct(const T* p, const Eigen::Vector2d& mark, double pixel_size) {
  const T x = (mark.x() * pixel_size - p[1]) * (1.0 + p[3]), y = p[2] - mark.y() * pixel_size;
  const T s = x * x + y * y, radial = s * (p[4] + s * (p[5] + s * p[6])), along = p[7] * x + p[8] * y;
  return {x + x * radial + p[7] * s + 2.0 * along * x, y + y * radial + p[8] * s + 2.0 * along * y};
}

}  // namespace

const std::vector<std::string>& PhotogrammetricLens::names() const {
  static const std::vector<std::string> all{"f", "px", "py", "aspect", "k1", "k2", "k3", "p1", "p2"};
  return all;
}

Camera PhotogrammetricLens::with_parameters(const Camera& camera, const Eigen::VectorXd& p) const {
  Camera out = camera;
  out.fx = out.fy = p[0] / pixel_size_;
  out.cx = p[1] / pixel_size_;
  out.cy = p[2] / pixel_size_;
  return out;
}

bool PhotogrammetricLens::residual(const Eigen::Ref<const Eigen::VectorXd>& p, const Eigen::Vector3d& point,
                                   const Eigen::Vector2d& mark, Residual& out) const {
  using Jet = ceres::Jet<double, 9>;
  if (!(point.z() > 0)) return false;
  std::array<Jet, 9> q;
  for (int i = 0; i < 9; ++i) q[static_cast<std::size_t>(i)] = Jet(p[i], i);
  const double x = point.x() / point.z(), y = point.y() / point.z();
  const auto seen = correct(q.data(), mark, pixel_size_);
  const Jet u = (q[0] * x - seen[0]) / pixel_size_, v = (q[0] * -y - seen[1]) / pixel_size_;
  out.value = {u.a, v.a};
  out.by_lens.resize(2, 9);
  out.by_lens.row(0) = u.v.transpose();
  out.by_lens.row(1) = v.v.transpose();
  out.by_point << 1, 0, -x, 0, -1, y;
  out.by_point *= p[0] / pixel_size_ / point.z();
  return true;
}

Eigen::Vector2d PhotogrammetricLens::corrected(const Eigen::VectorXd& p, const Eigen::Vector2d& mark) const {
  const auto seen = correct(p.data(), mark, pixel_size_);
  return Eigen::Vector2d(seen[0] + p[1], p[2] - seen[1]) / pixel_size_;
}

}  // namespace waymark::test
