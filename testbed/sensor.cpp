// SPDX-License-Identifier: Apache-2.0
#include "testbed/sensor.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/random.hpp"

namespace waymark::testbed {
namespace {

std::vector<double> gaussian(double sd) {
  const int reach = static_cast<int>(std::ceil(4 * sd));
  std::vector<double> weights;
  double sum = 0;
  for (int i = -reach; i <= reach; ++i) {
    // Integrated over the pixel, so that a blur of a third of a pixel keeps its width.
    const auto below = [sd](double x) { return 0.5 * std::erfc(-x / (sd * std::sqrt(2.0))); };
    weights.push_back(below(i + 0.5) - below(i - 0.5));
    sum += weights.back();
  }
  for (double& w : weights) w /= sum;
  return weights;
}

// One direction of the blur; stride (dx, dy) is (1, 0) or (0, 1).
Pixels blurred_along(const Pixels& image, const std::vector<double>& weights, std::int64_t dx,
                     std::int64_t dy) {
  const auto reach = std::ssize(weights) / 2;
  Pixels result(image.columns(), image.rows());
  tbb::parallel_for(std::int64_t{0}, image.rows(), [&](std::int64_t j) {
    for (std::int64_t i = 0; i < image.columns(); ++i) {
      if (std::isnan(image(i, j))) {
        result(i, j) = image(i, j);
        continue;
      }
      double sum = 0, weight = 0;
      for (std::int64_t k = -reach; k <= reach; ++k) {
        const std::int64_t x = i + k * dx, y = j + k * dy;
        if (!image.contains(x, y) || std::isnan(image(x, y))) continue;
        const double w = weights[static_cast<std::size_t>(k + reach)];
        sum += w * double(image(x, y)), weight += w;
      }
      result(i, j) = static_cast<float>(sum / weight);
    }
  });
  return result;
}

}  // namespace

Pixels gaussian_blur(const Pixels& image, double sd) {
  if (!(sd > 0)) return image;
  const std::vector<double> weights = gaussian(sd);
  return blurred_along(blurred_along(image, weights, 1, 0), weights, 0, 1);
}

Pixels apply_sensor(const Pixels& light, const Exposure& exposure, double sunlit, std::uint64_t noise_seed) {
  Pixels image = gaussian_blur(light, exposure.psf_sd);
  const double air = exposure.haze * sunlit;
  double sum = 0;
  std::int64_t count = 0;
  for (float& p : image.cells()) {
    if (std::isnan(p)) continue;
    p = static_cast<float>(double(p) * (1 - exposure.haze) + air);
    sum += double(p), ++count;
  }
  if (count == 0) return image;
  const double mean = sum / double(count);
  const double gain = exposure.level > 0 && mean > 0 ? exposure.level / mean : 1;
  tbb::parallel_for(std::int64_t{0}, image.rows(), [&](std::int64_t j) {
    Random random(mix_bits(noise_seed) ^ mix_bits(static_cast<std::uint64_t>(j)));
    for (float& p : image.row(j)) {
      const double noise = random.normal();
      if (std::isnan(p)) continue;
      double value = gain * (mean + exposure.contrast * (double(p) - mean));
      const double shot = exposure.shot_noise * exposure.shot_noise * std::max(0.0, value);
      value += noise * std::sqrt(exposure.read_noise * exposure.read_noise + shot);
      p = static_cast<float>(std::clamp(value, 0.0, 1.0));
    }
  });
  return image;
}

}  // namespace waymark::testbed
