// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/degradation_profiles.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::pipeline {
namespace {

constexpr double kStep = 0.02;  // radii
constexpr double kFar = 8;      // radii, where the solver ends
constexpr double kMaxBlur = 1.4, kBlurStep = 0.03;
constexpr double kShallowest = 0.02;

// Height in diameters, r in radii.
double fresh(double r) {
  return r < 1 ? 0.036 - 0.2 * (1 - std::pow(r, 2.2)) : 0.036 / (r * r * r);
}

// One explicit step of dz/dt = (1/r) d/dr (r dz/dr); blur^2 = 2 t.
void diffuse(std::vector<double>& z, std::vector<double>& next, double fraction) {
  next.front() = z[0] + 4 * fraction * (z[1] - z[0]);  // limit at r = 0
  for (std::size_t i = 1; i + 1 < z.size(); ++i) {
    const double inner = 1 - 0.5 / double(i), outer = 1 + 0.5 / double(i);
    next[i] = z[i] + fraction * (outer * (z[i + 1] - z[i]) - inner * (z[i] - z[i - 1]));
  }
  next.back() = next[z.size() - 2];
  z.swap(next);
}

double sampled(const std::vector<float>& z, double r) {
  const double position = std::min(r / kStep, double(z.size()) - 1.001);
  const auto i = static_cast<std::size_t>(position);
  return std::lerp(double(z[i]), double(z[i + 1]), position - double(i));
}

DegradationProfiles::State measured(double blur, const std::vector<double>& z) {
  const auto inside = static_cast<std::ptrdiff_t>(0.5 / kStep);
  const auto crest = std::max_element(z.begin() + inside, z.end()) - z.begin();
  auto edge = inside;
  double most = 0;
  for (auto i = inside; i <= crest; ++i) {
    const auto at = z.begin() + i;
    const double bend = 2 * at[0] - at[-1] - at[1];
    if (bend > most) most = bend, edge = i;
  }
  const double radius = double(crest) * kStep;
  return {(z[static_cast<std::size_t>(crest)] - z.front()) / radius, blur, radius,
          std::log(double(crest) / double(edge))};
}

}  // namespace

DegradationProfiles::DegradationProfiles() {
  std::vector<double> z(static_cast<std::size_t>(kFar / kStep) + 1), next(z.size());
  for (std::size_t i = 0; i < z.size(); ++i) z[i] = fresh(double(i) * kStep);
  constexpr double fraction = 0.2, time = fraction * kStep * kStep;
  double now = 0;
  for (double blur = 0; blur < kMaxBlur; blur += kBlurStep) {
    for (; now < blur * blur / 2; now += time) diffuse(z, next, fraction);
    blurs_.push_back(std::sqrt(2 * now));
    heights_.emplace_back(z.begin(), z.end());
    if (const State state = measured(blurs_.back(), z); state.depth >= kShallowest) states_.push_back(state);
  }
}

const DegradationProfiles& DegradationProfiles::instance() {
  static const DegradationProfiles craters;
  return craters;
}

double DegradationProfiles::height(double blur, double r) const {
  const auto after = std::upper_bound(blurs_.begin() + 1, blurs_.end() - 1, blur);
  const auto i = static_cast<std::size_t>(after - blurs_.begin());
  const double part = std::clamp((blur - blurs_[i - 1]) / (blurs_[i] - blurs_[i - 1]), 0.0, 1.0);
  return std::lerp(sampled(heights_[i - 1], r), sampled(heights_[i], r), part);
}

}  // namespace waymark::pipeline
