// SPDX-License-Identifier: Apache-2.0
#include "workflows/training/rock_scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.hpp"
#include "workflows/training/relief_shadows.hpp"
#include "workflows/training/rock_relief.hpp"
#include "workflows/training/value_noise.hpp"

namespace waymark::workflows {
namespace {

constexpr int kSamples = RockRelief::kSamples;

void blur(std::vector<float>& cells, std::int64_t w, std::int64_t h, double sd) {
  const auto half = static_cast<std::int64_t>(std::ceil(3.5 * sd));
  std::vector<float> mask;
  float total = 0;
  for (std::int64_t k = -half; k <= half; ++k) {
    mask.push_back(static_cast<float>(std::exp(-0.5 * static_cast<double>(k * k) / (sd * sd))));
    total += mask.back();
  }
  for (const bool across : {true, false}) {
    const std::vector<float> in = cells;
    for (std::int64_t y = 0; y < h; ++y)
      for (std::int64_t x = 0; x < w; ++x) {
        float sum = 0;
        for (std::int64_t k = -half; k <= half; ++k) {
          const auto u = across ? std::clamp<std::int64_t>(x + k, 0, w - 1) : x;
          const auto v = across ? y : std::clamp<std::int64_t>(y + k, 0, h - 1);
          sum += mask[static_cast<std::size_t>(k + half)] * in[static_cast<std::size_t>(v * w + u)];
        }
        cells[static_cast<std::size_t>(y * w + x)] = sum / total;
      }
  }
}

// Returns the brightness of each sample; level ground in the sun has about 1.
std::vector<float> shade(const RockScene& scene, const RockRelief& relief) {
  const double elevation = std::numbers::pi / 2 - to_radians(scene.incidence).value;
  const double angle = to_radians(scene.sun_angle).value;
  const double sx = std::cos(elevation) * std::cos(angle), sy = std::cos(elevation) * std::sin(angle),
               sz = std::sin(elevation);
  const ReliefShadows shadows(relief, elevation, angle);
  ValueNoise patchy(scene.seed * 3 + 2), small_patchy = patchy;
  std::vector<float> light(relief.heights.size());
  for (std::int64_t v = 1; v + 1 < relief.rows; ++v)
    for (std::int64_t u = 1; u + 1 < relief.columns; ++u) {
      const auto z = [&](std::int64_t a, std::int64_t b) { return static_cast<double>(relief(a, b)); };
      const double gx = 0.5 * kSamples * (z(u + 1, v) - z(u - 1, v)),
                   gy = 0.5 * kSamples * (z(u, v + 1) - z(u, v - 1));
      const double norm = std::sqrt(1 + gx * gx + gy * gy);
      const double cos_i = std::max(0.0, (sz - gx * sx - gy * sy) / norm), cos_e = 1 / norm;
      double lit = cos_i / sz;
      if (scene.lunar) lit = 0.5 * lit + 0.5 * (cos_i / (cos_i + cos_e)) * ((sz + 1) / sz);
      const double sunlight = cos_i > 0 && !shadows.is_shadowed(u, v) ? lit : 0;
      const double x = RockRelief::pixel(u), y = RockRelief::pixel(v);
      const double albedo =
          1 + scene.albedo * (patchy.at(x / 25, y / 25) + 0.5 * small_patchy.at(x / 6 + 50, y / 6));
      light[static_cast<std::size_t>(v * relief.columns + u)] = static_cast<float>(
          ((1 - scene.skylight) * sunlight + scene.skylight) * albedo * (1 - scene.haze) + scene.haze);
    }
  return light;
}

// Returns what a camera makes of the brightness: means of pixels with noise.
Pixels expose(const RockScene& scene, const std::vector<float>& light, std::int64_t light_columns) {
  Pixels pixels(scene.columns, scene.rows);
  Random noise(scene.seed, "noise");
  for (std::int64_t y = 0; y < scene.rows; ++y)
    for (std::int64_t x = 0; x < scene.columns; ++x) {
      double sum = 0;
      for (int dv = 0; dv < kSamples; ++dv)
        for (int du = 0; du < kSamples; ++du)
          sum += static_cast<double>(
              light[static_cast<std::size_t>(((y + RockRelief::kMargin) * kSamples + dv) * light_columns +
                                             (x + RockRelief::kMargin) * kSamples + du)]);
      double value = scene.sunlit * (sum / (kSamples * kSamples) + noise.normal(0, scene.noise));
      if (scene.quantise) value = std::clamp(std::round(value), 0.0, 255.0);
      pixels(x, y) = static_cast<float>(value);
    }
  return pixels;
}

}  // namespace

RockImage render(const RockScene& scene) {
  RockRelief relief = make_rock_relief(scene);
  std::vector<float> light = shade(scene, relief);
  blur(light, relief.columns, relief.rows, scene.blur * kSamples);
  return {expose(scene, light, relief.columns), std::move(relief.rocks)};
}

}  // namespace waymark::workflows
