// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/outliers.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace waymark::pipeline {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<MarkResidual> mark_residuals(const Network& network) {
  std::vector<MarkResidual> out;
  for (const auto& term : network.terms) {
    if (!term->is_mark()) continue;
    Term::Linear linear;
    const bool seen = network.linearize(*term, linear);
    out.push_back({term.get(), seen ? linear.residual.norm() : kInfinity});
  }
  return out;
}

// Length that a pair of standard normal variables exceeds with the probability of |x| > limit for one.
double limit_of_pair(double limit) {
  return std::sqrt(-2 * std::log(std::erfc(limit / std::sqrt(2.0))));
}

// Unknowns take up part of the residuals: the expected mean square is the fraction of redundancy.
double redundancy_fraction(const Network& network) {
  double rows = 0;
  for (const auto& term : network.terms) rows += term->rows;
  const auto unknowns = static_cast<double>(network.camera_columns + network.point_columns);
  return rows > 0 ? std::clamp(1 - unknowns / rows, 0.1, 1.0) : 1;
}

}  // namespace

std::vector<MarkResidual> marks_behind(const Network& network) {
  std::vector<MarkResidual> out = mark_residuals(network);
  std::erase_if(out, [](const MarkResidual& m) { return m.size < kInfinity; });
  return out;
}

std::vector<MarkResidual> outlying_marks(const Network& network, double limit) {
  std::vector<MarkResidual> out = mark_residuals(network);
  if (out.empty() || !(limit > 0)) return {};
  std::vector<double> sizes;
  for (const MarkResidual& m : out) sizes.push_back(m.size);
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  const double median_of_pair = std::sqrt(2 * std::log(2.0));
  const double sigma = *middle / median_of_pair / std::sqrt(redundancy_fraction(network));
  const double largest = std::max(sigma * limit_of_pair(limit), 1e-6);  // exact marks have no outliers
  std::erase_if(out, [&](const MarkResidual& m) { return m.size <= largest; });
  return out;
}

double blunder_statistic(const Network& network, const NetworkCovariance& covariance, const Term& term,
                         double sigma0) {
  Term::Linear linear;
  if (!covariance.determined || !network.linearize(term, linear)) return 0;
  Eigen::MatrixXd cofactor = Eigen::MatrixXd::Identity(term.rows, term.rows);
  // The covariance between a point and a pose is not at hand: such a residual counts with its own deviation
  // alone, which makes the statistic too small rather than too large.
  const bool mixed = term.blocks.size() > 1 && std::ranges::any_of(term.blocks, [&](std::size_t b) {
                       return network.blocks[b].kind == Block::Kind::point;
                     });
  for (std::size_t i = 0; i < term.blocks.size() && !mixed; ++i)
    for (std::size_t j = 0; j < term.blocks.size(); ++j) {
      const Block &a = network.blocks[term.blocks[i]], &b = network.blocks[term.blocks[j]];
      if (a.free.empty() || b.free.empty()) continue;
      if (a.kind == Block::Kind::point) {
        if (!covariance.points[term.blocks[i]]) return 0;
        cofactor -= linear.by_block[i] * *covariance.points[term.blocks[i]] * linear.by_block[j].transpose();
        continue;
      }
      for (std::size_t m = 0; m < a.free.size(); ++m)
        for (std::size_t n = 0; n < b.free.size(); ++n)
          cofactor -= linear.by_block[i].col(a.free[m]) *
                      covariance.cameras(a.column + static_cast<Eigen::Index>(m),
                                         b.column + static_cast<Eigen::Index>(n)) *
                      linear.by_block[j].col(b.free[n]).transpose();
    }
  // Components without redundancy keep a residual of 0 whatever their error is.
  constexpr double kNone = 1e-6;
  Eigen::VectorXd residual = linear.residual;
  int rows = term.rows;
  for (int row = 0; row < term.rows; ++row) {
    if (cofactor(row, row) > kNone) continue;
    cofactor.row(row).setZero();
    cofactor.col(row).setZero();
    cofactor(row, row) = 1;
    residual[row] = 0;
    --rows;
  }
  const Eigen::LDLT<Eigen::MatrixXd> factors(cofactor);
  if (rows == 0 || !(factors.vectorD().minCoeff() > kNone * kNone)) return 0;
  const double squares = residual.dot(factors.solve(residual)) / std::max(1.0, sigma0 * sigma0);
  const double spread = 2.0 / (9 * rows);
  return std::max(0.0, (std::cbrt(squares / rows) - (1 - spread)) / std::sqrt(spread));
}

}  // namespace waymark::pipeline
