// SPDX-License-Identifier: Apache-2.0
#include "pipeline/buildings/roof_plane.hpp"

#include <algorithm>

namespace waymark::pipeline {
namespace {

constexpr double kMin = 6;           // returns
constexpr double kMinAcross = 0.15;  // m: least standard deviation of the positions across their long axis
constexpr double kSquare = 1e-6;     // m2 per mm2

}  // namespace

void PlaneSums::add(const CellSums& sums, const Eigen::Vector2d& centre) {
  const auto metres = [](std::int64_t mm) { return static_cast<double>(mm) / 1000; };
  const auto square = [](std::int64_t mm2) { return static_cast<double>(mm2) * kSquare; };
  const double n = static_cast<double>(sums.count);
  const Eigen::Vector2d o = centre - at_;
  const double x = metres(sums.x), y = metres(sums.y), z = metres(sums.z) - n * z_;
  n_ += n;
  sx_ += x + n * o.x(), sy_ += y + n * o.y(), sz_ += z;
  xx_ += square(sums.xx) + 2 * o.x() * x + n * o.x() * o.x();
  yy_ += square(sums.yy) + 2 * o.y() * y + n * o.y() * o.y();
  xy_ += square(sums.xy) + o.x() * y + o.y() * x + n * o.x() * o.y();
  xz_ += square(sums.xz) - z_ * x + o.x() * z;
  yz_ += square(sums.yz) - z_ * y + o.y() * z;
  zz_ += square(sums.zz) - 2 * z_ * metres(sums.z) + n * z_ * z_;
}

std::optional<RoofPlane> PlaneSums::fit() const {
  if (!(n_ >= kMin)) return {};
  const double mx = sx_ / n_, my = sy_ / n_, mz = sz_ / n_;
  const double cxx = xx_ / n_ - mx * mx, cyy = yy_ / n_ - my * my, cxy = xy_ / n_ - mx * my;
  const double cxz = xz_ / n_ - mx * mz, cyz = yz_ / n_ - my * mz, czz = zz_ / n_ - mz * mz;
  const double half = (cxx + cyy) / 2, across = half - std::hypot((cxx - cyy) / 2, cxy);
  if (!(across > kMinAcross * kMinAcross)) return {};
  const double det = cxx * cyy - cxy * cxy;
  RoofPlane plane{.at = at_ + Eigen::Vector2d(mx, my), .at_z = z_ + mz};
  plane.slope_x = (cyy * cxz - cxy * cyz) / det;
  plane.slope_y = (cxx * cyz - cxy * cxz) / det;
  const double left = czz - plane.slope_x * cxz - plane.slope_y * cyz;
  plane.rms = std::sqrt(std::max(0.0, left) * n_ / (n_ - 3)) * plane.cosine();
  return plane;
}

double rms_distance(const CellSums& sums, const Eigen::Vector2d& centre, const RoofPlane& plane) {
  if (sums.count == 0) return 0;
  const double n = static_cast<double>(sums.count);
  const auto mean = [&](std::int64_t sum) { return static_cast<double>(sum) / n / 1000; };
  const auto moment = [&](std::int64_t ab, std::int64_t a, std::int64_t b) {
    return static_cast<double>(ab) / n * kSquare - mean(a) * mean(b);
  };
  const double mx = mean(sums.x), my = mean(sums.y), b = plane.slope_x, c = plane.slope_y;
  const double off = mean(sums.z) - plane.z(centre.x() + mx, centre.y() + my);
  const double spread = moment(sums.zz, sums.z, sums.z) + b * b * moment(sums.xx, sums.x, sums.x) +
                        c * c * moment(sums.yy, sums.y, sums.y) - 2 * b * moment(sums.xz, sums.x, sums.z) -
                        2 * c * moment(sums.yz, sums.y, sums.z) + 2 * b * c * moment(sums.xy, sums.x, sums.y);
  return std::sqrt(off * off + std::max(0.0, spread)) * plane.cosine();
}

}  // namespace waymark::pipeline
