// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/relief_scene.hpp"

#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "pipeline/craters/scene_picture.hpp"
#include "pipeline/craters/scene_relief.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kMinPixels = 12;
constexpr double kMinDepth = 0.03;  // diameters
constexpr double kUnclear = 0.2;    // clarity of craters that count neither way

// Turned window of the relief: pixel (x, y) lies at start + turn * (x, y).
struct Window {
  double column, row;   // of the window's centre
  double zoom;          // pixels per cell
  double cosine, sine;  // of the turn
  double narrow;        // width of a cell over its height
  double middle;        // (side - 1) / 2

  cv::Matx23d to_relief() const {
    const double x = 1 / (zoom * narrow), y = 1 / zoom;
    return {cosine * x, -sine * x,  column - (cosine - sine) * middle * x,
            sine * y,   cosine * y, row - (sine + cosine) * middle * y};
  }
  LabelledCrater in_window(const CataloguedCrater& c) const {
    const double u = (c.column - column) * narrow * zoom, v = (c.row - row) * zoom;
    return {middle + u * cosine + v * sine, middle - u * sine + v * cosine, c.diameter * zoom, 1};
  }
};

}  // namespace

LabelledScene relief_scene(const CrateredRelief& relief, std::uint64_t seed, int side) {
  Random random(seed, "scene of measured relief");
  const double zoom = random.log_uniform(kMinReliefZoom, 1), turn = random.uniform(0, 2 * std::numbers::pi);
  const double reach = 0.72 * side / zoom;
  Window window{random.uniform(reach, double(relief.heights.columns()) - reach),
                random.uniform(reach, double(relief.heights.rows()) - reach),
                zoom,
                std::cos(turn),
                std::sin(turn),
                1,
                (side - 1) / 2.0};
  window.narrow = relief.cell_widths.at(static_cast<std::size_t>(window.row));

  const cv::Mat1f all(static_cast<int>(relief.heights.rows()), static_cast<int>(relief.heights.columns()),
                      const_cast<float*>(relief.heights.cells().data()));
  Grid<float> heights(side, side);
  cv::Mat1f seen(side, side, heights.cells().data());
  cv::warpAffine(all, seen, window.to_relief(), seen.size(), cv::INTER_CUBIC | cv::WARP_INVERSE_MAP,
                 cv::BORDER_REPLICATE);
  seen *= zoom;

  const double elevation = random.log_uniform(8, 45) * std::numbers::pi / 180;
  LabelledScene scene;
  scene.image = light_relief(heights, elevation, random.bernoulli(0.5) ? random.uniform(0, 0.15) : 0.01,
                             random.uniform());
  const Grid<float> patches = fractal_field(random, side, side / 2.0, 4, random.uniform(0.4, 0.8));
  const double mottled = random.log_uniform(0.01, 0.12);
  cv::Mat1f image(side, side, scene.image.cells().data());
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) image(y, x) *= static_cast<float>(std::exp(mottled * patches(x, y)));
  cv::GaussianBlur(image, image, {}, random.uniform(0.3, 0.9));
  const double noise = random.log_uniform(0.003, 0.04) * cv::mean(image)[0];
  for (float& value : image) value += static_cast<float>(random.normal(0, noise));

  for (const CataloguedCrater& known : relief.craters) {
    LabelledCrater c = window.in_window(known);
    const double radius = c.diameter / 2;
    if (c.x < -radius || c.y < -radius || c.x > side - 1 + radius || c.y > side - 1 + radius) continue;
    const bool whole = c.x >= radius && c.y >= radius && c.x <= side - 1 - radius && c.y <= side - 1 - radius;
    if (!whole || known.diameter < kMinReliefDiameter || c.diameter < kMinPixels ||
        known.depth_ratio < kMinDepth)
      c.clarity = kUnclear;
    scene.craters.push_back(c);
  }
  stretch_contrast(scene.image, random);
  turn_quarters(scene, static_cast<int>(random.uniform_index(4)));
  return scene;
}

}  // namespace waymark::pipeline
