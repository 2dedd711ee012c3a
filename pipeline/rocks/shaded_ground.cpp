// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/shaded_ground.hpp"

namespace waymark::pipeline {

double ShadedGround::fraction() const {
  return pixels > 0 ? static_cast<double>(shaded) / static_cast<double>(pixels) : 0;
}

bool ShadedGround::is_much() const {
  constexpr double kMuch = 0.1;
  return fraction() >= kMuch;
}

ShadedGround& ShadedGround::operator+=(const ShadedGround& other) {
  pixels += other.pixels;
  shaded += other.shaded;
  return *this;
}

}  // namespace waymark::pipeline
