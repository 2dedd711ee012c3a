// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include "localization/motion_model.hpp"
namespace waymark::planning {

/// Symmetric 3 x 3 matrix of x, y, yaw: a covariance (m^2, m rad, rad^2) or an information matrix.
struct Symmetric3 {
  double xx = 0, xy = 0, yy = 0, xt = 0, yt = 0, tt = 0;

  Eigen::Matrix3d matrix() const;
  friend bool operator==(const Symmetric3&, const Symmetric3&) = default;
};

/// Adds `factor` times a matrix to a sum.
inline void add(Symmetric3& sum, const Symmetric3& more, double factor) {
  sum.xx += factor * more.xx, sum.xy += factor * more.xy, sum.yy += factor * more.yy;
  sum.xt += factor * more.xt, sum.yt += factor * more.yt, sum.tt += factor * more.tt;
}

/// Returns the upper triangle of a symmetric matrix.
Symmetric3 symmetric(const Eigen::Matrix3d& matrix);

/// Drive of `length` metres straight along a unit direction, after a turn on the spot, radians.
struct DriveStep {
  double length = 0, east = 1, north = 0, turn = 0;
};

/// Returns the covariance after a drive with the odometry noise of the localizers. Exact for noise that is
/// continuous along the path: two half steps equal one whole step.
inline Symmetric3 predict(const Symmetric3& covariance, const DriveStep& step,
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
  // Yaw lost on the path moves the rest of it aside: integrals of q, q (length - l), q (length - l)^2.
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

/// Returns the adjugate of a matrix: its inverse times its determinant.
inline Symmetric3 adjugate(const Symmetric3& m) {
  return {m.yy * m.tt - m.yt * m.yt, m.xt * m.yt - m.xy * m.tt, m.xx * m.tt - m.xt * m.xt,
          m.xy * m.yt - m.yy * m.xt, m.xy * m.xt - m.xx * m.yt, m.xx * m.yy - m.xy * m.xy};
}

/// Returns (P^-1 + J)^-1 for a positive definite covariance P and information J >= 0.
inline Symmetric3 update(const Symmetric3& covariance, const Symmetric3& information) {
  if (information == Symmetric3{}) return covariance;
  const Symmetric3& p = covariance;
  // P^-1 = A / d with the adjugate A and the determinant d, so (P^-1 + J)^-1 = d (A + d J)^-1: one division.
  Symmetric3 sum = adjugate(p);
  const double d = p.xx * sum.xx + p.xy * sum.xy + p.xt * sum.xt;
  add(sum, information, d);
  const Symmetric3 a = adjugate(sum);
  const double scale = d / (sum.xx * a.xx + sum.xy * a.xy + sum.xt * a.xt);
  return {a.xx * scale, a.xy * scale, a.yy * scale, a.xt * scale, a.yt * scale, a.tt * scale};
}

/// Returns the standard deviation of the position in its worst direction, metres.
inline double position_sd(const Symmetric3& p) {
  const double half = (p.xx - p.yy) / 2;
  return std::sqrt(std::max(0.0, (p.xx + p.yy) / 2 + std::sqrt(half * half + p.xy * p.xy)));
}

/// Returns whether `scale` a - b is positive definite: b is the smaller covariance.
inline bool exceeds(const Symmetric3& a, const Symmetric3& b, double scale = 1) {
  const double xx = scale * a.xx - b.xx, xy = scale * a.xy - b.xy, yy = scale * a.yy - b.yy;
  const double minor = xx * yy - xy * xy;
  if (!(xx > 0 && minor > 0)) return false;
  const double xt = scale * a.xt - b.xt, yt = scale * a.yt - b.yt, tt = scale * a.tt - b.tt;
  return tt * minor - xt * (xt * yy - yt * xy) - yt * (yt * xx - xt * xy) > 0;
}

}  // namespace waymark::planning
