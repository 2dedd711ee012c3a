// SPDX-License-Identifier: Apache-2.0
#include "landmarks/crater_degradation.hpp"

#include <cmath>

namespace waymark::inline landmarks {
namespace {

constexpr double kDepth = 0.2, kRim = 0.036;  // diameters
constexpr double kBowl = 2.2;                 // exponent of the bowl
constexpr double kFraction = 0.2;             // step over spacing^2; stable below 0.5

void diffuse(std::vector<double>& z, std::vector<double>& next) {
  next.front() = z[0] + 4 * kFraction * (z[1] - z[0]);  // limit at r = 0
  for (std::size_t i = 1; i + 1 < z.size(); ++i) {
    const double inner = 1 - 0.5 / double(i), outer = 1 + 0.5 / double(i);
    next[i] = z[i] + kFraction * (outer * (z[i + 1] - z[i]) - inner * (z[i] - z[i - 1]));
  }
  next.back() = next[z.size() - 2];
  z.swap(next);
}

}  // namespace

double fresh_crater_height(double r) {
  return r < 1 ? kRim - kDepth * (1 - std::pow(r, kBowl)) : kRim / (r * r * r);
}

DiffusingCrater::DiffusingCrater(double reach) {
  for (std::size_t i = 0; i <= static_cast<std::size_t>(reach / kSpacing); ++i)
    heights_.push_back(fresh_crater_height(double(i) * kSpacing));
  next_.resize(heights_.size());
}

void DiffusingCrater::advance_to(double time) {
  for (; time_ < time; time_ += kFraction * kSpacing * kSpacing) diffuse(heights_, next_);
}

}  // namespace waymark::inline landmarks
