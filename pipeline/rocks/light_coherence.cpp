// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/light_coherence.hpp"

#include "pipeline/vision/real_fraction.hpp"

namespace waymark::pipeline {
namespace {

// Fraction along the axis at which the ground is none that the detector was made for, and at which nothing
// speaks against it (docs/evaluation/2026-11-23-unknown-ground.md).
constexpr PropertyLimits kAlongTheLight{.alien = 0.58, .usual = 0.62};

}  // namespace

double LightCoherence::fraction() const {
  return rocks > 0 ? static_cast<double>(along) / static_cast<double>(rocks) : 0.5;
}

double LightCoherence::real_fraction() const {
  return pipeline::real_fraction(along, rocks, kAlongTheLight);
}

LightCoherence& LightCoherence::operator+=(const LightCoherence& other) {
  rocks += other.rocks;
  along += other.along;
  return *this;
}

}  // namespace waymark::pipeline
