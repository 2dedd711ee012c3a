// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/lens_model.hpp"

#include <ceres/jet.h>

#include <cmath>

namespace waymark::pipeline {
namespace {

// Radial and tangential terms as in geo/camera.cpp, for numbers with derivatives.
struct BrownTerms {
  static constexpr int kCount = 9;
  static const std::vector<std::string>& names() {
    static const std::vector<std::string> all{"f", "aspect", "cx", "cy", "k1", "k2", "k3", "p1", "p2"};
    return all;
  }
  static constexpr std::array<std::size_t, 5> kCoefficients{0, 1, 4, 2, 3};  // k1 k2 k3 p1 p2 in Camera

  template <class T>
  static void distort(const Camera& camera, const T* k, T& x, T& y) {
    const auto& d = camera.distortion;
    const T s = x * x + y * y;
    const T under = 1.0 + s * (d[5] + s * (d[6] + s * d[7]));
    const T radial = (1.0 + s * (k[0] + s * (k[1] + s * k[2]))) / under;
    const T x0 = x, y0 = y;
    x = x0 * radial + 2.0 * k[3] * x0 * y0 + k[4] * (s + 2.0 * x0 * x0);
    y = y0 * radial + k[3] * (s + 2.0 * y0 * y0) + 2.0 * k[4] * x0 * y0;
  }
};

struct FisheyeTerms {
  static constexpr int kCount = 8;
  static const std::vector<std::string>& names() {
    static const std::vector<std::string> all{"f", "aspect", "cx", "cy", "k1", "k2", "k3", "k4"};
    return all;
  }
  static constexpr std::array<std::size_t, 4> kCoefficients{0, 1, 2, 3};

  template <class T>
  static void distort(const Camera&, const T* k, T& x, T& y) {
    using std::atan;
    using std::sqrt;
    const T r2 = x * x + y * y;
    if (r2 < 1e-18) return;  // theta / r = 1 to 1e-18
    const T r = sqrt(r2), theta = atan(r), s = theta * theta;
    const T scale = theta * (1.0 + s * (k[0] + s * (k[1] + s * (k[2] + s * k[3])))) / r;
    x *= scale;
    y *= scale;
  }
};

template <class Terms>
class CameraLens final : public LensModel {
 public:
  explicit CameraLens(const Camera& camera) : camera_(camera) {}

  const std::vector<std::string>& names() const override { return Terms::names(); }

  Eigen::VectorXd parameters(const Camera& camera) const override {
    Eigen::VectorXd p(Terms::kCount);
    p.head<4>() << camera.fx, camera.fy / camera.fx, camera.cx, camera.cy;
    Eigen::Index i = 4;
    for (const std::size_t k : Terms::kCoefficients) p[i++] = camera.distortion[k];
    return p;
  }

  Camera with_parameters(const Camera& camera, const Eigen::VectorXd& p) const override {
    Camera out = camera;
    out.fx = p[0];
    out.fy = p[0] * p[1];
    out.cx = p[2];
    out.cy = p[3];
    Eigen::Index i = 4;
    for (const std::size_t k : Terms::kCoefficients) out.distortion[k] = p[i++];
    return out;
  }

  bool residual(const Eigen::Ref<const Eigen::VectorXd>& p, const Eigen::Vector3d& point,
                const Eigen::Vector2d& mark, Residual& out) const override {
    constexpr int kLens = Terms::kCount;
    using Jet = ceres::Jet<double, kLens + 2>;
    const double depth = point.z();
    if (!(depth > 1e-12 * point.norm())) return false;
    std::array<Jet, kLens> q;
    for (int i = 0; i < kLens; ++i) q[static_cast<std::size_t>(i)] = Jet(p[i], i);
    const double px = point.x() / depth, py = point.y() / depth;
    Jet x(px, kLens), y(py, kLens + 1);
    Terms::distort(camera_, q.data() + 4, x, y);
    const Jet u = q[0] * x + camera_.skew * y + q[2] - mark.x(), v = q[0] * q[1] * y + q[3] - mark.y();
    out.value = {u.a, v.a};
    out.by_lens.resize(2, kLens);
    out.by_lens.row(0) = u.v.template head<kLens>().transpose();
    out.by_lens.row(1) = v.v.template head<kLens>().transpose();
    Eigen::Matrix2d by_image;
    by_image.row(0) = u.v.template tail<2>().transpose();
    by_image.row(1) = v.v.template tail<2>().transpose();
    Eigen::Matrix<double, 2, 3> by_camera;
    by_camera << 1, 0, -px, 0, 1, -py;
    out.by_point = by_image * by_camera / depth;
    return out.value.allFinite() && out.by_lens.allFinite() && out.by_point.allFinite();
  }

 private:
  Camera camera_;
};

}  // namespace

std::shared_ptr<const LensModel> lens_model(const Camera& camera) {
  if (camera.lens == Camera::Lens::fisheye) return std::make_shared<CameraLens<FisheyeTerms>>(camera);
  return std::make_shared<CameraLens<BrownTerms>>(camera);
}

}  // namespace waymark::pipeline
