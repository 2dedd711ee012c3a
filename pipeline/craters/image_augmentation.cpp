// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/image_augmentation.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/random.hpp"

namespace waymark::pipeline {
namespace {

void blur(cv::Mat1f& image, double deviation) {
  cv::GaussianBlur(image, image, {}, deviation);
}

void add_noise(cv::Mat1f& image, Random& random, double strength) {
  for (float& value : image) value += static_cast<float>(random.normal(0, strength));
}

void add_uneven_light(cv::Mat1f& image, Random& random, double strength) {
  cv::Mat1f coarse(3, 3), light;
  for (float& value : coarse) value = static_cast<float>(random.normal(0, strength));
  cv::resize(coarse, light, image.size(), 0, 0, cv::INTER_CUBIC);
  image += light;
}

void add_stripes(cv::Mat1f& image, Random& random, double strength) {
  for (int x = 0; x < image.cols; ++x) image.col(x) += random.normal(0, strength);
}

// Flat-fielding, which makes faint terrain visible: the brightness of whole regions is removed.
void flat_field(cv::Mat1f& image, double region, double part) {
  cv::Mat1f mean;
  cv::GaussianBlur(image, mean, {}, region);
  image -= part * mean;
}

// A quarter is equalised, wholly or partly; the others are stretched between two quantiles.
void adjust_tones(cv::Mat1f& image, Random& random) {
  std::vector<float> sorted(image.begin(), image.end());
  std::sort(sorted.begin(), sorted.end());
  const auto quantile = [&](double fraction) {
    return double(sorted[static_cast<std::size_t>(fraction * double(sorted.size() - 1))]);
  };
  const bool equalise = random.bernoulli(0.25);
  const double cut = equalise ? 0.001 : random.log_uniform(1e-4, 6e-2);
  const double low = quantile(equalise ? cut : cut * random.uniform()),
               high = std::max(quantile(1 - cut), low + 1e-6);
  const double equal = equalise ? random.uniform(0.4, 1) : 0, gamma = equalise ? 1 : random.uniform(0.6, 1.6);
  for (float& value : image) {
    double to = std::pow(std::clamp((value - low) / (high - low), 0.0, 1.0), gamma);
    if (equalise) {
      const auto rank = std::lower_bound(sorted.begin(), sorted.end(), value) - sorted.begin();
      to = equal * double(rank) / double(sorted.size()) + (1 - equal) * to;
    }
    value = static_cast<float>(255 * to);
  }
}

// JPEG compression: blocks of 8 pixels, cosine coefficients rounded, higher frequencies more coarsely (ITU-T
// T.81, its tables as a ramp).
void compress_jpeg(cv::Mat1f& image, double coarseness) {
  cv::Mat1f terms(8, 8);
  for (int y = 0; y + 8 <= image.rows; y += 8)
    for (int x = 0; x + 8 <= image.cols; x += 8) {
      cv::Mat1f square = image(cv::Rect(x, y, 8, 8));
      cv::dct(square, terms);
      for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 8; ++i) {
          const double step = coarseness * (1 + 0.35 * (i + j));
          terms(j, i) = static_cast<float>(step * std::round(terms(j, i) / step));
        }
      cv::idct(terms, square);
    }
}

}  // namespace

void augment_image(Pixels& pixels, std::uint64_t seed) {
  Random random(seed, "published otherwise");
  cv::Mat1f image(static_cast<int>(pixels.rows()), static_cast<int>(pixels.columns()), pixels.cells().data());
  cv::Scalar mean, spread;
  cv::meanStdDev(image, mean, spread);
  if (random.bernoulli(0.4)) blur(image, random.uniform(0.3, 1.1));
  if (random.bernoulli(0.3)) add_uneven_light(image, random, 0.35 * spread[0]);
  if (random.bernoulli(0.35)) {
    add_noise(image, random, spread[0] * random.log_uniform(0.03, 0.3));
    if (random.bernoulli(0.4)) blur(image, random.uniform(0.5, 0.9));
  }
  if (random.bernoulli(0.15)) add_stripes(image, random, spread[0] * random.log_uniform(0.02, 0.12));
  if (random.bernoulli(0.3)) {
    const double region = random.log_uniform(25, 90);
    flat_field(image, region, random.uniform(0.4, 1));
  }
  adjust_tones(image, random);
  if (random.bernoulli(0.4)) compress_jpeg(image, random.log_uniform(3, 25));
  for (float& value : image) value = std::round(std::clamp(value, 0.0F, 255.0F));
  if (random.bernoulli(0.25)) {
    const double shrink = random.uniform(0.55, 0.9);
    cv::Mat1f coarse;
    cv::resize(image, coarse, {}, shrink, shrink, cv::INTER_AREA);
    cv::resize(coarse, image, image.size(), 0, 0, cv::INTER_CUBIC);
  }
}

}  // namespace waymark::pipeline
