// SPDX-License-Identifier: Apache-2.0
#include "planning/belief.hpp"

namespace waymark::planning {

Eigen::Matrix3d Symmetric3::matrix() const {
  Eigen::Matrix3d m;
  m << xx, xy, xt, xy, yy, yt, xt, yt, tt;
  return m;
}

Symmetric3 symmetric(const Eigen::Matrix3d& m) {
  return {m(0, 0), (m(0, 1) + m(1, 0)) / 2, m(1, 1), (m(0, 2) + m(2, 0)) / 2, (m(1, 2) + m(2, 1)) / 2,
          m(2, 2)};
}

}  // namespace waymark::planning
