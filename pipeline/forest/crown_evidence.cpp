// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/crown_evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/forest/canopy_window.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kSurroundings = 12;                          // metres
constexpr std::array<double, 4> kScales{0.6, 1.2, 2.4, 4.8};  // metres
constexpr std::array<double, 2> kRoughScales{0.6, 1.2};       // metres, scales of the gradients
constexpr double kRoughMean = 2.4;                            // metres

/// Smooths planes; unknown pixels are NaN and have no weight.
class Smoothing {
 public:
  explicit Smoothing(const ColourWindow& image) : image_(image) {}

  Grid<float> operator()(const Grid<float>& plane, double sigma) const {
    CanopyWindow window{image_.cells, plane, image_.cell, image_.cell};
    for (float& value : window.heights.cells())
      if (std::isnan(value)) value = kNoCanopy;
    Grid<float> smooth = smooth_canopy(window, sigma).heights;
    for (float& value : smooth.cells())
      if (value == kNoCanopy) value = std::nanf("");
    return smooth;
  }

 private:
  const ColourWindow& image_;
};

/// Combines planes pixel by pixel.
template <class Rule, class... Planes>
Grid<float> combine(Rule rule, const Grid<float>& first, const Planes&... others) {
  Grid<float> out(first.columns(), first.rows());
  for (std::size_t i = 0; i < out.cells().size(); ++i)
    out.cells()[i] = rule(first.cells()[i], others.cells()[i]...);
  return out;
}

/// Magnitude of the gradient times `cells`; 0 at the edge of known pixels.
Grid<float> steepness(const Grid<float>& plane, float cells) {
  Grid<float> out(plane.columns(), plane.rows());
  const auto difference = [](float a, float b) {
    return std::isnan(a) || std::isnan(b) ? 0.0F : (b - a) / 2;
  };
  for (std::int64_t r = 0; r < plane.rows(); ++r)
    for (std::int64_t c = 0; c < plane.columns(); ++c) {
      const auto at = [&](std::int64_t dc, std::int64_t dr) {
        return plane.contains(c + dc, r + dr) ? plane(c + dc, r + dr) : std::nanf("");
      };
      const float across = difference(at(-1, 0), at(1, 0)), down = difference(at(0, -1), at(0, 1));
      out(c, r) = std::isnan(plane(c, r)) ? std::nanf("") : cells * std::sqrt(across * across + down * down);
    }
  return out;
}

float ratio(float a, float b, float min_sum) {
  return (a - b) / std::max(a + b, min_sum);
}

}  // namespace

std::int64_t crown_evidence_reach(double cell) {
  const std::int64_t smooth =
      std::max(smoothing_reach(kScales.back(), cell),
               smoothing_reach(kRoughScales.back(), cell) + 1 + smoothing_reach(kRoughMean, cell));
  return smoothing_reach(kSurroundings, cell) + smooth;
}

std::vector<Grid<float>> crown_evidence(const ColourWindow& image) {
  const Smoothing smooth(image);
  const Grid<float>&red = image.bands.at(0), &green = image.bands.at(1), &blue = image.bands.at(2);
  const Grid<float> brightness =
      combine([](float r, float g, float b) { return (r + g + b) / 3; }, red, green, blue);
  const Grid<float> around = smooth(brightness, kSurroundings);
  const auto against = [](float value, float mean) { return value / (mean + 0.03F); };
  const Grid<float> relative = combine(against, brightness, around);
  const Grid<float> excess_green =
      combine([](float r, float g, float b) { return (2 * g - r - b) / std::max(r + g + b, 0.06F); }, red,
              green, blue);
  const auto dark = [](float index, float light) { return std::max(index, 0.0F) * std::exp(-1.5F * light); };

  std::vector<Grid<float>> bases;
  if (image.bands.size() > 3) {
    const Grid<float>& infrared = image.bands[3];
    bases.push_back(combine([](float i, float r) { return ratio(i, r, 0.04F); }, infrared, red));
    bases.push_back(combine(against, infrared, around));
    bases.push_back(combine(dark, bases[0], relative));
  } else {
    bases.push_back(combine([](float g, float r) { return ratio(g, r, 0.04F); }, green, red));
    bases.push_back(
        combine([&](float e, float light) { return 4 * dark(e, light); }, excess_green, relative));
  }
  bases.push_back(relative);
  bases.push_back(excess_green);
  bases.push_back(combine([](float b, float r) { return ratio(b, r, 0.04F); }, blue, red));

  std::vector<Grid<float>> evidence;
  for (const Grid<float>& base : bases)
    for (const double scale : kScales) evidence.push_back(smooth(base, scale));
  for (const double scale : kRoughScales) {
    evidence.push_back(steepness(smooth(relative, scale), static_cast<float>(scale / image.cell)));
    evidence.push_back(smooth(evidence.back(), kRoughMean));
  }
  return evidence;
}

}  // namespace waymark::pipeline
