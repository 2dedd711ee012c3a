// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "pipeline/craters/bowl_template.hpp"
#include "pipeline/craters/filled_image.hpp"
#include "pipeline/craters/find_craters.hpp"
#include "pipeline/craters/pixel_noise.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kBowl = 11;    // diameter of a bowl, pixels of its pyramid level
constexpr double kClear = 0.7;  // minimum correlation
constexpr int kSectors = 72;

struct LitBowl {
  double angle, weight;
};

// The slope template is linear in the direction of the light, so correlations along x and along y give that
// of every direction, and the best direction of each bowl.
void bowls_of_level(const cv::Mat1f& image, std::vector<LitBowl>& bowls) {
  const auto shape_x = bowl_template(kBowl, Radians{0}, BowlLight::slope),
             shape_y = bowl_template(kBowl, Radians{kPi / 2}, BowlLight::slope);
  const int side = static_cast<int>(shape_x.columns());
  const auto matrix = [&](const Pixels& p) {
    return cv::Mat1f(side, side, const_cast<float*>(p.cells().data()));
  };
  cv::Mat1f along_x, along_y, mean, squares;
  cv::filter2D(image, along_x, CV_32F, matrix(shape_x), {-1, -1}, 0, cv::BORDER_REFLECT_101);
  cv::filter2D(image, along_y, CV_32F, matrix(shape_y), {-1, -1}, 0, cv::BORDER_REFLECT_101);
  cv::boxFilter(image, mean, CV_32F, {side, side}, {-1, -1}, true, cv::BORDER_REFLECT_101);
  cv::sqrBoxFilter(image, squares, CV_32F, {side, side}, {-1, -1}, true, cv::BORDER_REFLECT_101);
  const double noise = pixel_noise(image.ptr<float>(), image.cols, image.rows);
  cv::Mat1f score(image.size());
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x) {
      const double variance =
          std::max(0.0, double(squares(y, x)) - double(mean(y, x)) * mean(y, x)) + noise * noise;
      score(y, x) =
          variance > 0
              ? static_cast<float>(std::hypot(along_x(y, x), along_y(y, x)) / (side * std::sqrt(variance)))
              : 0.0F;
    }
  cv::Mat1f highest;
  cv::dilate(score, highest, cv::Mat::ones(5, 5, CV_8U));
  const int edge = side / 2;
  for (int y = edge; y < image.rows - edge; ++y)
    for (int x = edge; x < image.cols - edge; ++x)
      if (score(y, x) >= kClear && score(y, x) >= highest(y, x))
        bowls.push_back(
            {std::atan2(double(along_y(y, x)), double(along_x(y, x))), double(score(y, x)) - kClear});
}

double apart(double a, double b) {
  return std::abs(std::remainder(a - b, 2 * kPi));
}

// Sum of weights near a direction.
double support(const std::vector<LitBowl>& bowls, double angle) {
  double sum = 0;
  for (const LitBowl& bowl : bowls) {
    const double off = apart(bowl.angle, angle) / 0.35;  // 20 degrees
    if (off < 3) sum += bowl.weight * std::exp(-0.5 * off * off);
  }
  return sum;
}

}  // namespace

std::optional<CraterSunAngle> estimate_crater_sun_angle(const Pixels& image) {
  const FilledImage whole = fill_holes(image);
  if (whole.flat) return {};
  cv::Mat1f level = cv::Mat1f(static_cast<int>(image.rows()), static_cast<int>(image.columns()),
                              const_cast<float*>(whole.pixels.cells().data()))
                        .clone();
  std::vector<LitBowl> bowls;
  // Half-octave steps from the finest that is at most 2 Mpx.
  while (level.total() > 2'000'000) cv::resize(level, level, {}, 0.5, 0.5, cv::INTER_AREA);
  for (; std::min(level.cols, level.rows) >= 3 * kBowl;
       cv::resize(level, level, {}, std::numbers::sqrt2 / 2, std::numbers::sqrt2 / 2, cv::INTER_AREA))
    bowls_of_level(level, bowls);
  double best = 0, angle = 0;
  for (int i = 0; i < kSectors; ++i) {
    const double here = 2 * kPi * i / kSectors, s = support(bowls, here);
    if (s > best) best = s, angle = here;
  }
  // Mean of the bowls within 40 degrees, twice.
  double sd = 0, count = 0;
  for (int round = 0; round < 3; ++round) {
    double sum = 0, squares = 0, total = 0;
    count = 0;
    for (const LitBowl& bowl : bowls) {
      const double off = std::remainder(bowl.angle - angle, 2 * kPi);
      if (std::abs(off) > 0.7) continue;
      sum += bowl.weight * off, squares += bowl.weight * off * off, total += bowl.weight, ++count;
    }
    if (!(total > 0)) return {};
    sd = std::sqrt(squares / total);
    angle += sum / total;
  }
  if (count < 3) return {};
  double result = std::remainder(angle, 2 * kPi);
  if (result <= -kPi) result += 2 * kPi;
  return CraterSunAngle{{result}, {sd}, static_cast<int>(count)};
}

}  // namespace waymark::pipeline
