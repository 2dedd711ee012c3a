// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/allometry_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.hpp"
#include "core/random.hpp"

namespace waymark::pipeline {
namespace {

struct Pair {
  double x = 0, diameter = 0;
  int fold = 0;
};

struct Curve {
  double a = 0, b = 0;
  double operator()(double x) const { return a * std::pow(x, b); }
};

// Best factor for an exponent, and the residual.
std::pair<double, double> factor_and_residual(const std::vector<Pair>& pairs, double b, int without) {
  double df = 0, ff = 0, dd = 0;
  for (const Pair& p : pairs) {
    if (p.fold == without) continue;
    const double f = std::pow(p.x, b);
    df += p.diameter * f, ff += f * f, dd += p.diameter * p.diameter;
  }
  const double a = ff > 0 ? df / ff : 0;
  return {a, dd - a * df};
}

// Least squares: the factor is linear, the exponent is found by golden section search.
Curve fit_curve(const std::vector<Pair>& pairs, int without) {
  constexpr double kGolden = 0.6180339887498949;
  double low = 0.05, high = 4;
  double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
  double at_left = factor_and_residual(pairs, left, without).second;
  double at_right = factor_and_residual(pairs, right, without).second;
  for (int i = 0; i < 60; ++i) {
    if (at_left < at_right) {
      high = right, right = left, at_right = at_left;
      left = high - kGolden * (high - low);
      at_left = factor_and_residual(pairs, left, without).second;
    } else {
      low = left, left = right, at_left = at_right;
      right = low + kGolden * (high - low);
      at_right = factor_and_residual(pairs, right, without).second;
    }
  }
  const double b = (low + high) / 2;
  return {factor_and_residual(pairs, b, without).first, b};
}

Allometry fit_row(const std::vector<Pair>& pairs, AllometryForm form, const AllometryFitOptions& how) {
  const Curve all = fit_curve(pairs, -1);
  Allometry row{.form = form, .a = all.a, .b = all.b};
  const auto count = static_cast<double>(pairs.size());
  double squares = 0, log_squares = 0;
  for (const Pair& p : pairs) {
    squares += std::pow(p.diameter - all(p.x), 2);
    log_squares += std::pow(std::log(p.diameter / all(p.x)), 2);
  }
  row.trees = static_cast<std::int64_t>(pairs.size());
  row.rmse = std::sqrt(squares / count);
  row.sigma = std::sqrt(log_squares / std::max(1.0, count - 2));
  double held_out = 0, bias = 0;
  for (int fold = 0; fold < how.folds; ++fold) {
    if (std::ranges::none_of(pairs, [&](const Pair& p) { return p.fold == fold; })) continue;
    const Curve curve = fit_curve(pairs, fold);
    for (const Pair& p : pairs)
      if (p.fold == fold) {
        held_out += std::pow(curve(p.x) - p.diameter, 2);
        bias += curve(p.x) - p.diameter;
      }
  }
  row.held_out_rmse = std::sqrt(held_out / count);
  row.held_out_bias = bias / count;
  // stem_diameter() multiplies this form by exp(sigma^2 / 2); the fit is already unbiased.
  if (form == AllometryForm::height_crown) row.a /= std::exp(row.sigma * row.sigma / 2);
  return row;
}

Allometry best_row(const std::vector<const MeasuredTree*>& trees, const AllometryFitOptions& how) {
  std::vector<Pair> by_height, by_crown;
  std::size_t number = 0;
  for (const MeasuredTree* tree : trees) {
    const std::string key = tree->plot.empty() ? fmt::format("tree {}", number) : "plot " + tree->plot;
    const int fold = static_cast<int>(named_seed(how.seed, key) % static_cast<std::uint64_t>(how.folds));
    by_height.push_back({tree->height - 1.3, tree->diameter, fold});
    if (tree->crown > 0) by_crown.push_back({tree->height * tree->crown, tree->diameter, fold});
    ++number;
  }
  const Allometry plain = fit_row(by_height, AllometryForm::height, how);
  if (by_crown.size() != by_height.size()) return plain;
  const Allometry crowned = fit_row(by_crown, AllometryForm::height_crown, how);
  return crowned.held_out_rmse < plain.held_out_rmse ? crowned : plain;
}

}  // namespace

std::vector<Allometry> fit_allometry(std::span<const MeasuredTree> trees, const AllometryFitOptions& how) {
  std::map<std::string, std::vector<const MeasuredTree*>> by_species;
  std::vector<const MeasuredTree*> all;
  for (const MeasuredTree& tree : trees) {
    if (!(tree.height > 1.4) || !(tree.diameter > 0)) continue;
    all.push_back(&tree);
    by_species[tree.species].push_back(&tree);
  }
  if (all.size() < 5)
    throw Error(
        ErrorCode::input,
        fmt::format("{} trees of {} have a height above 1.3 m and a diameter: too few to fit a curve to",
                    all.size(), trees.size()),
        "", "at least five are needed, fifty for a useful table");
  const auto named = [](Allometry row, const std::string& species) {
    row.species = species;
    row.source = "waymark allometry fit";
    return row;
  };
  std::vector<Allometry> table{named(best_row(all, how), "all")};
  for (const auto& [species, group] : by_species)
    if (species != "all" && !species.empty() && static_cast<int>(group.size()) >= how.min_trees)
      table.push_back(named(best_row(group, how), species));
  return table;
}

}  // namespace waymark::pipeline
