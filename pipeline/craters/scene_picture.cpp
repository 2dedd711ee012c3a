// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/scene_picture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <vector>

namespace waymark::pipeline {

Pixels light_relief(const Grid<float>& heights, double elevation, double sky, double lommel) {
  const int side = static_cast<int>(heights.columns());
  Pixels brightness(side, side);
  for (int y = 0; y < side; ++y) {
    double shadow = -1e9;  // height of the shadow edge above this cell
    for (int x = 0; x < side; ++x) {
      const double h = heights(x, y);
      shadow -= std::tan(elevation);
      const auto at = [&](int column, int row) {
        return double(heights(std::clamp(column, 0, side - 1), std::clamp(row, 0, side - 1)));
      };
      const double gx = (at(x + 1, y) - at(x - 1, y)) / 2, gy = (at(x, y + 1) - at(x, y - 1)) / 2;
      const double upright = 1 / std::sqrt(1 + gx * gx + gy * gy);
      const double incidence = std::max(0.0, (std::sin(elevation) + gx * std::cos(elevation)) * upright);
      const double direct =
          lommel > 0 ? (1 - lommel) * incidence + lommel * 2 * incidence / (incidence + upright) : incidence;
      const double lit = std::clamp((h - shadow) / 0.5 + 1, 0.0, 1.0);
      brightness(x, y) = static_cast<float>(lit * direct + sky * upright);
      shadow = std::max(shadow, h);
    }
  }
  return brightness;
}

void stretch_contrast(Pixels& image, Random& random) {
  std::vector<float> sorted(image.cells().begin(), image.cells().end());
  std::sort(sorted.begin(), sorted.end());
  const double cut = random.bernoulli(0.5) ? random.log_uniform(1e-4, 3e-2) : random.log_uniform(1e-4, 2e-3);
  const auto at = [&](double fraction) {
    return double(sorted[static_cast<std::size_t>(fraction * double(sorted.size() - 1))]);
  };
  const double low = random.bernoulli(0.3) ? std::min(at(0.001), 0.0) : at(cut),
               high = at(1 - cut * random.uniform(0.3, 2));
  const double gamma = random.uniform(0.7, 1.4), scale = std::max(1e-6, high - low);
  const double highest = random.bernoulli(0.85) ? 255 : 4000;
  for (float& value : image.cells())
    value = static_cast<float>(
        std::round(highest * std::pow(std::clamp((value - low) / scale, 0.0, 1.0), gamma)));
}

void turn_quarters(LabelledScene& scene, int quarters) {
  const auto side = static_cast<int>(scene.image.columns());
  cv::Mat1f image(side, side, scene.image.cells().data());
  for (int i = 0; i < quarters; ++i) {
    cv::Mat1f turned;
    cv::rotate(image, turned, cv::ROTATE_90_CLOCKWISE);  // (x, y) -> (last - y, x)
    turned.copyTo(image);
    for (LabelledCrater& c : scene.craters) c = {double(side - 1) - c.y, c.x, c.diameter, c.clarity};
  }
  scene.sun_angle = {
      std::remainder(std::numbers::pi + quarters * std::numbers::pi / 2, 2 * std::numbers::pi)};
}

}  // namespace waymark::pipeline
