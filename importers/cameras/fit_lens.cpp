// SPDX-License-Identifier: Apache-2.0
#include "importers/cameras/fit_lens.hpp"

#include <Eigen/QR>
#include <algorithm>

#include "core/solve.hpp"

namespace waymark::importers {

FittedLens fit_brown(const std::vector<LensPair>& pairs) {
  const auto count = static_cast<Eigen::Index>(pairs.size());
  Eigen::MatrixXd terms(2 * count, 5);
  Eigen::VectorXd moved(2 * count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& [p, distorted] = pairs[static_cast<std::size_t>(i)];
    const double x = p.x(), y = p.y(), s = p.squaredNorm();
    terms.row(2 * i) << x * s, x * s * s, 2 * x * y, s + 2 * x * x, x * s * s * s;
    terms.row(2 * i + 1) << y * s, y * s * s, s + 2 * y * y, 2 * x * y, y * s * s * s;
    moved.segment<2>(2 * i) = distorted - p;
  }
  FittedLens fitted;
  if (count < 5) return fitted;
  const Eigen::VectorXd k = solve_least_squares(terms, moved);
  std::copy_n(k.data(), 5, fitted.distortion.begin());
  const Eigen::VectorXd miss = terms * k - moved;
  for (Eigen::Index i = 0; i < count; ++i)
    fitted.max_error = std::max(fitted.max_error, miss.segment<2>(2 * i).norm());
  return fitted;
}

}  // namespace waymark::importers
