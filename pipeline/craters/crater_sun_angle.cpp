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
constexpr double kNearAxis = 0.7;  // 40 degrees

constexpr int kLead = 4;  // bowls by which one side has to lead: 30 : 1 if 3 of 10 are inverted

struct LitBowl {
  double angle, weight;
};

/// Bowls found up to a level of the pyramid.
using LevelEnds = std::vector<std::size_t>;

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

// Whether the light comes from the opposite of `axis`. Rocks, which are lit like inverted bowls, outnumber
// craters at sizes up to theirs only. So the bowls are counted from the largest down, until one side leads.
bool is_opposite(const std::vector<LitBowl>& bowls, const LevelEnds& ends, double axis) {
  int lead = 0;
  for (std::size_t level = ends.size(); level-- > 0 && std::abs(lead) < kLead;)
    for (std::size_t i = level > 0 ? ends[level - 1] : 0; i < ends[level]; ++i) {
      lead += apart(bowls[i].angle, axis) < kNearAxis;
      lead -= apart(bowls[i].angle, axis + kPi) < kNearAxis;
    }
  if (std::abs(lead) >= kLead) return lead < 0;
  return support(bowls, axis + kPi) > support(bowls, axis);
}

// Whether bowls lit from `angle` have the sizes of craters, whose number falls with the square of the
// diameter or slower: ten are at least twice the smallest size, or the larger ones are half as many as the
// smallest.
bool sizes_of_craters(const std::vector<LitBowl>& bowls, const LevelEnds& ends, double angle) {
  const auto count = [&](std::size_t level) {
    const std::size_t from = std::min(level, ends.size()), begin = from > 0 ? ends[from - 1] : 0;
    return std::count_if(bowls.begin() + std::ptrdiff_t(begin), bowls.end(),
                         [&](const LitBowl& bowl) { return apart(bowl.angle, angle) < kNearAxis; });
  };
  return count(2) >= 10 || 3 * count(1) >= count(0);  // levels are half an octave apart
}

}  // namespace

std::optional<CraterSunAngle> estimate_crater_sun_angle(const Pixels& image) {
  const FilledImage whole = fill_holes(image);
  if (whole.flat) return {};
  cv::Mat1f level = cv::Mat1f(static_cast<int>(image.rows()), static_cast<int>(image.columns()),
                              const_cast<float*>(whole.pixels.cells().data()))
                        .clone();
  std::vector<LitBowl> bowls;
  LevelEnds ends;
  // Half-octave steps from the finest that is at most 2 Mpx.
  while (level.total() > 2'000'000) cv::resize(level, level, {}, 0.5, 0.5, cv::INTER_AREA);
  for (; std::min(level.cols, level.rows) >= 3 * kBowl;
       cv::resize(level, level, {}, std::numbers::sqrt2 / 2, std::numbers::sqrt2 / 2, cv::INTER_AREA)) {
    bowls_of_level(level, bowls);
    ends.push_back(bowls.size());
  }
  double best = 0, axis = 0;
  for (int i = 0; i < kSectors / 2; ++i) {
    const double here = 2 * kPi * i / kSectors, s = support(bowls, here) + support(bowls, here + kPi);
    if (s > best) best = s, axis = here;
  }
  double angle = is_opposite(bowls, ends, axis) ? axis + kPi : axis;
  // Mean of the bowls within 40 degrees, thrice; inverted ones show the axis as well.
  double sd = 0, count = 0;
  for (int round = 0; round < 3; ++round) {
    double sum = 0, squares = 0, total = 0;
    count = 0;
    for (const LitBowl& bowl : bowls) {
      const double off = std::remainder(bowl.angle - angle, kPi);
      if (std::abs(off) > kNearAxis) continue;
      sum += bowl.weight * off, squares += bowl.weight * off * off, total += bowl.weight;
      count += apart(bowl.angle, angle) < kNearAxis;
    }
    if (!(total > 0)) return {};
    sd = std::sqrt(squares / total);
    angle += sum / total;
  }
  if (count < 3) return {};
  double result = std::remainder(angle, 2 * kPi);
  if (result <= -kPi) result += 2 * kPi;
  return CraterSunAngle{{result}, {sd}, static_cast<int>(count), sizes_of_craters(bowls, ends, result)};
}

}  // namespace waymark::pipeline
