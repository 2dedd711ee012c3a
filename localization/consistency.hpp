// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
namespace waymark {

/// Whether errors are as large as a filter says.
struct Consistency {
  double anees = 0;          ///< mean of e' P^-1 e over its number of dimensions: 1 is consistent
  double independent = 0;    ///< poses without memory that would say as much as these, at least 1
  double low = 0, high = 0;  ///< 95 % band of `anees` for a consistent filter
};

/// Judges the squared errors e' P^-1 e of one drive at ascending times `t`; both not empty and equally long.
/// Innovations too, where `dimensions` is the mean number of their rows.
/// Errors of neighbouring poses are alike, so a long drive is worth far fewer poses than it has:
/// `independent` is the effective sample size, the number over the sum of all autocorrelations, cut off by
/// the initial monotone sequence of Geyer (1992). The band is the chi-square one for that many. It is an
/// estimate from the drive itself: in simulated drives of consistent filters about 19 of 20 lie inside.
Consistency consistency(std::span<const double> t, std::span<const double> squares, double dimensions);

}  // namespace waymark
