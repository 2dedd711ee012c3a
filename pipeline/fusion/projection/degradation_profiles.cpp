// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/degradation_profiles.hpp"

#include <algorithm>
#include <cmath>

#include "landmarks/crater_degradation.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kStep = DiffusingCrater::kSpacing;
constexpr double kFar = 8;  // radii, where the solver ends
constexpr double kMaxBlur = 1.4, kBlurStep = 0.03;
constexpr double kShallowest = 0.02;

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
  DiffusingCrater crater(kFar);
  const std::vector<double>& z = crater.heights();
  for (double blur = 0; blur < kMaxBlur; blur += kBlurStep) {
    crater.advance_to(blur * blur / 2);
    blurs_.push_back(std::sqrt(2 * crater.time()));
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
