// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/light_coherence.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::pipeline {
namespace {

constexpr std::int64_t kEnough = 30;  // rocks; fewer allow no statement

// Fraction along the axis at which the ground is none that the detector was made for, and at which nothing
// speaks against it (docs/evaluation/2026-11-23-unknown-ground.md).
constexpr double kAlien = 0.58, kUsual = 0.62;
constexpr double kMinFraction = 0.02;

}  // namespace

double LightCoherence::fraction() const {
  return rocks > 0 ? static_cast<double>(along) / static_cast<double>(rocks) : 0.5;
}

double LightCoherence::real_fraction() const {
  if (rocks < kEnough) return 1;
  const double upper = fraction() + 1 / std::sqrt(static_cast<double>(rocks));  // two standard deviations
  return std::clamp((upper - kAlien) / (kUsual - kAlien), kMinFraction, 1.0);
}

LightCoherence& LightCoherence::operator+=(const LightCoherence& other) {
  rocks += other.rocks;
  along += other.along;
  return *this;
}

}  // namespace waymark::pipeline
