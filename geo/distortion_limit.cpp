// SPDX-License-Identifier: Apache-2.0
#include "geo/distortion_limit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace waymark::inline geo {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Polynomial = std::vector<double>;  // a0 + a1 s + a2 s^2 + ...

double value(const Polynomial& p, double s) {
  double sum = 0;
  for (auto a = p.rbegin(); a != p.rend(); ++a) sum = sum * s + *a;
  return sum;
}

Polynomial derivative(const Polynomial& p) {
  Polynomial out;
  for (std::size_t n = 1; n < p.size(); ++n) out.push_back(static_cast<double>(n) * p[n]);
  return out;
}

Polynomial product(const Polynomial& a, const Polynomial& b) {
  Polynomial out(a.size() + b.size() - 1, 0);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) out[i + j] += a[i] * b[j];
  return out;
}

void trim(Polynomial& p) {
  while (!p.empty() && p.back() == 0) p.pop_back();
}

double bisect(const Polynomial& p, double low, double high) {
  const bool rises = value(p, low) < 0;
  for (int step = 0; step < 200; ++step) {
    const double middle = (low + high) / 2;
    if (middle <= low || middle >= high) break;
    ((value(p, middle) < 0) == rises ? low : high) = middle;
  }
  return low;
}

// Returns all s > 0 at which the polynomial changes sign or touches zero between monotone pieces, ascending.
std::vector<double> positive_roots(Polynomial p) {
  trim(p);
  if (p.size() < 2) return {};
  double largest = 0;  // Cauchy's bound
  for (std::size_t n = 0; n + 1 < p.size(); ++n) largest = std::max(largest, std::abs(p[n] / p.back()));
  std::vector<double> stops = positive_roots(derivative(p));
  stops.push_back(1 + largest);
  std::vector<double> roots;
  double low = 0;
  for (const double high : stops) {
    if (!(high > low)) continue;
    const double at_low = value(p, low), at_high = value(p, high);
    if (at_high == 0)
      roots.push_back(high);
    else if ((at_low < 0) != (at_high < 0) && at_low != 0)
      roots.push_back(bisect(p, low, high));
    low = high;
  }
  return roots;
}

// r N(s) / D(s) with s = r^2 increases while N D + 2 s (N' D - N D') > 0 and D > 0.
double brown_limit(const std::array<double, 8>& k) {
  const Polynomial over{1, k[0], k[1], k[4]}, under{1, k[5], k[6], k[7]};
  Polynomial slope = product(over, under);
  const Polynomial down = product(derivative(over), under), up = product(over, derivative(under));
  for (std::size_t n = 0; n < down.size(); ++n) slope[n + 1] += 2 * (down[n] - up[n]);
  return std::sqrt(std::min(first_positive_root(slope), first_positive_root(under)));
}

double fisheye_limit(const std::array<double, 8>& k) {
  const double s = first_positive_root({1, 3 * k[0], 5 * k[1], 7 * k[2], 9 * k[3]});
  return std::min(std::sqrt(s), std::numbers::pi / 2);
}

}  // namespace

double first_positive_root(const std::vector<double>& coefficients) {
  const auto roots = positive_roots(coefficients);
  return roots.empty() ? kInfinity : roots.front();
}

double distortion_limit(const Camera& camera) {
  struct Known {
    Camera::Lens lens = Camera::Lens::brown;
    std::array<double, 8> distortion{};
    double field = kInfinity;
  };
  thread_local Known known;
  if (known.lens != camera.lens || known.distortion != camera.distortion)
    known = {camera.lens, camera.distortion,
             camera.lens == Camera::Lens::brown ? brown_limit(camera.distortion)
                                                : fisheye_limit(camera.distortion)};
  return known.field;
}

}  // namespace waymark::inline geo
