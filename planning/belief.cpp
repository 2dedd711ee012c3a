// SPDX-License-Identifier: Apache-2.0
#include "planning/belief.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::planning {
namespace {

Symmetric3 inverse(const Symmetric3& m) {
  const double a = m.yy * m.tt - m.yt * m.yt, b = m.xt * m.yt - m.xy * m.tt, c = m.xy * m.yt - m.yy * m.xt;
  const double scale = 1 / (m.xx * a + m.xy * b + m.xt * c);
  return {a * scale,
          b * scale,
          (m.xx * m.tt - m.xt * m.xt) * scale,
          c * scale,
          (m.xy * m.xt - m.xx * m.yt) * scale,
          (m.xx * m.yy - m.xy * m.xy) * scale};
}

}  // namespace

Eigen::Matrix3d Symmetric3::matrix() const {
  Eigen::Matrix3d m;
  m << xx, xy, xt, xy, yy, yt, xt, yt, tt;
  return m;
}

void add(Symmetric3& sum, const Symmetric3& more, double factor) {
  sum.xx += factor * more.xx, sum.xy += factor * more.xy, sum.yy += factor * more.yy;
  sum.xt += factor * more.xt, sum.yt += factor * more.yt, sum.tt += factor * more.tt;
}

Symmetric3 symmetric(const Eigen::Matrix3d& m) {
  return {m(0, 0), (m(0, 1) + m(1, 0)) / 2, m(1, 1), (m(0, 2) + m(2, 0)) / 2, (m(1, 2) + m(2, 1)) / 2,
          m(2, 2)};
}

Symmetric3 predict(const Symmetric3& covariance, const DriveStep& step,
                   const localization::OdometryNoise& noise) {
  Symmetric3 p = covariance;
  p.tt += noise.yaw_per_radian * std::abs(step.turn);
  const double c = step.east, s = step.north, length = step.length;
  const double ax = -length * s, ay = length * c;  // of the position by the yaw
  p.xx += 2 * ax * p.xt + ax * ax * p.tt;
  p.xy += ax * p.yt + ay * p.xt + ax * ay * p.tt;
  p.yy += 2 * ay * p.yt + ay * ay * p.tt;
  p.xt += ax * p.tt;
  p.yt += ay * p.tt;
  // Yaw that is lost on the path moves the rest of it aside: integrals of q, q (length - l), q (length -
  // l)^2.
  const double q = noise.yaw_per_metre * length, sideways = q * length / 2;
  const double along = noise.along_per_metre * length;
  const double across = noise.across_per_metre * length + q * length * length / 3;
  p.xx += along * c * c + across * s * s;
  p.xy += (along - across) * c * s;
  p.yy += along * s * s + across * c * c;
  p.xt -= sideways * s;
  p.yt += sideways * c;
  p.tt += q;
  return p;
}

Symmetric3 update(const Symmetric3& covariance, const Symmetric3& information) {
  if (information == Symmetric3{}) return covariance;
  const Symmetric3 i = inverse(covariance);
  return inverse({i.xx + information.xx, i.xy + information.xy, i.yy + information.yy, i.xt + information.xt,
                  i.yt + information.yt, i.tt + information.tt});
}

double position_sd(const Symmetric3& p) {
  return std::sqrt(std::max(0.0, (p.xx + p.yy) / 2 + std::hypot((p.xx - p.yy) / 2, p.xy)));
}

bool exceeds(const Symmetric3& a, const Symmetric3& b, double scale) {
  const double xx = scale * a.xx - b.xx, xy = scale * a.xy - b.xy, yy = scale * a.yy - b.yy;
  const double minor = xx * yy - xy * xy;
  if (!(xx > 0 && minor > 0)) return false;
  const double xt = scale * a.xt - b.xt, yt = scale * a.yt - b.yt, tt = scale * a.tt - b.tt;
  return tt * minor - xt * (xt * yy - yt * xy) - yt * (yt * xx - xt * xy) > 0;
}

}  // namespace waymark::planning
