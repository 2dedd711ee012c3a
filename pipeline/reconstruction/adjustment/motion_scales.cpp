// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/motion_scales.hpp"

#include <algorithm>
#include <cmath>

#include "core/median.hpp"

namespace waymark::pipeline {
namespace {

// Mean over the rows of a term of squared residual and its variance, in units of the stated variance.
double expected_square(const Network& network, const NetworkCovariance& covariance, const Term& term,
                       const Term::Linear& linear, double variance) {
  double sum = linear.residual.squaredNorm() / variance;
  for (std::size_t i = 0; i < term.blocks.size(); ++i)
    for (std::size_t j = 0; j < term.blocks.size(); ++j) {
      const Block &a = network.blocks[term.blocks[i]], &b = network.blocks[term.blocks[j]];
      for (std::size_t m = 0; m < a.free.size(); ++m)
        for (std::size_t n = 0; n < b.free.size(); ++n)
          sum += linear.by_block[i].col(a.free[m]).dot(linear.by_block[j].col(b.free[n])) *
                 covariance.cameras(a.column + static_cast<Eigen::Index>(m),
                                    b.column + static_cast<Eigen::Index>(n));
    }
  return sum / term.rows;
}

double scale_change(const std::vector<double>& squares) {
  constexpr double kMaxOfMedian = 10, kMaxChange = 10;
  if (squares.empty()) return 1;
  const double limit = kMaxOfMedian * median(squares);
  double sum = 0, count = 0;
  for (const double square : squares)
    if (square <= limit) sum += square, ++count;
  const double change = count > 0 ? std::sqrt(sum / count) : 1;
  return std::isfinite(change) && change > 0 ? std::clamp(change, 1 / kMaxChange, kMaxChange) : 1;
}

}  // namespace

MotionScales motion_scale_changes(const Network& network, const NetworkCovariance& covariance,
                                  const std::vector<bool>& left_out, double sigma0) {
  std::vector<double> shifts, turns;
  const double variance = sigma0 > 0 ? sigma0 * sigma0 : 1;
  for (const auto& term : network.terms) {
    Term::Linear linear;
    if (term->kind != Term::Kind::motion || left_out[term->index] || !network.linearize(*term, linear))
      continue;
    // A shift is compared with poses, a turn with a value.
    (term->blocks.size() > 1 ? shifts : turns)
        .push_back(expected_square(network, covariance, *term, linear, variance));
  }
  return {scale_change(shifts), scale_change(turns)};
}

}  // namespace waymark::pipeline
