// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/crater_model.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace waymark {

CraterVerdict judge(const CraterModel& model, const CraterFeatures& features) {
  std::vector<float> in(features.begin(), features.end()), out;
  for (const CraterModel::Layer& layer : model.layers) {
    assert(static_cast<std::size_t>(layer.inputs) == in.size());
    out = layer.biases;
    const float* weight = layer.weights.data();
    for (float& sum : out) {
      float total = 0;
      for (const float value : in) total += *weight++ * value;
      sum += total;
    }
    if (&layer != &model.layers.back())
      for (float& value : out) value = value > 0 ? value : 0.1F * value;
    in.swap(out);
  }
  assert(in.size() == 4);
  return {1 / (1 + std::exp(-double(in[0]))), std::clamp(0.1 * in[1], -0.5, 0.5),
          std::clamp(0.1 * in[2], -0.5, 0.5), std::clamp(0.1 * in[3], -0.7, 0.7)};
}

CraterCandidate corrected(const CraterCandidate& c, const CraterVerdict& verdict, Radians sun_angle) {
  const double u = verdict.along * c.diameter, v = verdict.across * c.diameter;
  const double cosine = std::cos(sun_angle.value), sine = std::sin(sun_angle.value);
  return {c.x + u * cosine - v * sine, c.y + u * sine + v * cosine, c.diameter * std::exp(verdict.log_size),
          c.score};
}

}  // namespace waymark
