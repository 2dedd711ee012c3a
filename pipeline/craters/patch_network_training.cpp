// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/patch_network_training.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "core/random.hpp"
#include "pipeline/craters/bowl_candidates.hpp"
#include "pipeline/craters/convolution_training.hpp"
#include "pipeline/craters/crater_training.hpp"

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

constexpr double kMinClarity = 0.25;  // minimum clarity of a crater that annotators mark
constexpr double kPositionWeight = 0.3;

ConvolutionNet untrained_network() {
  const auto layer = [](int side, int channels, int kernel, int stride, int outputs, int scalars = 0) {
    return Convolution{side, channels, scalars, kernel, stride, outputs, {}, {}};
  };
  return {layer(kWidePatchSide, 1, 5, 2, 8), layer(10, 8, 4, 2, 16), layer(4, 16, 3, 1, 32),
          layer(2, 32, 2, 1, 32, kScalarInputs), layer(1, 32, 1, 1, 4)};
}

// Mirroring swaps the rows, since the light runs along them.
WidePatch mirror_patch(const WidePatch& wide) {
  WidePatch other = wide;
  for (std::size_t row = 0; row < kWidePatchSide; ++row)
    std::copy_n(wide.patch.begin() + static_cast<std::ptrdiff_t>((kWidePatchSide - 1 - row) * kWidePatchSide),
                kWidePatchSide, other.patch.begin() + static_cast<std::ptrdiff_t>(row * kWidePatchSide));
  return other;
}

// Radiometric augmentation.
void jitter_tones(WidePatch& wide, Random& random) {
  auto& patch = wide.patch;
  if (random.bernoulli(0.5)) {
    const double a = random.normal(0, 0.08), b = random.uniform(-0.05, 0.02);
    for (float& v : patch) v += static_cast<float>(a * v * v + b * v * v * v);
  }
  if (random.bernoulli(0.3)) {
    const auto top = static_cast<float>(random.uniform(0.6, 2)),
               low = static_cast<float>(-random.uniform(0.8, 3));
    for (float& v : patch) v = std::clamp(v, low, top);
  }
  if (random.bernoulli(0.3)) {
    const double along = random.normal(0, 0.03), across = random.normal(0, 0.03);
    for (int i = 0; i < kWidePatchSide * kWidePatchSide; ++i)
      patch[static_cast<std::size_t>(i)] +=
          static_cast<float>(along * (i % kWidePatchSide - kWidePatchSide / 2) +
                             across * (i / kWidePatchSide - kWidePatchSide / 2));
  }
  if (random.bernoulli(0.3)) {
    const double noise = random.uniform(0, 0.3);
    for (float& v : patch) v += static_cast<float>(random.normal(0, noise));
  }
  normalise(patch);
}

// Computes the gradient of the loss by the four outputs; returns the loss. Label smoothing: 2 %.
double loss_gradient(std::span<const float> out, const WidePatchExample& example, bool mirror,
                     std::array<float, 4>& slope) {
  const double p = 1 / (1 + std::exp(-double(out[0]))), wanted = example.crater ? 0.98 : 0.02;
  slope[0] = static_cast<float>(p - wanted);
  const std::array<float, 3> place{10 * example.along, (mirror ? -10 : 10) * example.across,
                                   10 * example.log_size};
  for (std::size_t i = 0; i < 3; ++i) {
    const float off = example.crater ? out[i + 1] - place[i] : 0;
    slope[i + 1] = static_cast<float>(kPositionWeight) * std::clamp(off, -1.0F, 1.0F);
  }
  return -wanted * std::log(p + 1e-9) - (1 - wanted) * std::log(1 - p + 1e-9);
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

std::vector<WidePatchExample> make_patch_examples(const LabelledScene& scene, std::uint64_t seed) {
  Random random(seed, "crater looks");
  const Radians sun{scene.sun_angle.value + random.normal(0, 0.1)};
  Pixels image = scene.image;
  augment_image(image, seed);
  const double side = double(std::min(image.columns(), image.rows()));
  const auto found = suppress_overlaps(
      bowl_candidates(image,
                      {.sun_angle = sun,
                       .limits = {.min_diameter = 7, .max_diameter = 0.6 * side, .min_correlation = 0.5}}),
      0.5);
  const PatchSource source(image, sun);
  const double cosine = std::cos(sun.value), sine = std::sin(sun.value);
  std::vector<WidePatchExample> examples;
  for (CraterCandidate c : found) {
    const double correlation = c.score;
    // Perturbed as by rounds of correction.
    if (random.bernoulli(0.6)) {
      c.x += random.normal(0, 0.05) * c.diameter, c.y += random.normal(0, 0.05) * c.diameter;
      c.diameter *= std::exp(random.normal(0, 0.09));
    }
    const auto [best, common] = match_crater(scene, c);
    WidePatchExample e;
    e.crater = common >= 0.5 && best->clarity >= kMinClarity;
    if (!e.crater && common > 0.3 && !(common >= 0.5 && best->clarity < kMinClarity / 2)) continue;
    if (!e.crater && random.bernoulli(0.5)) continue;
    e.wide = source.wide_patch(c, correlation);
    if (e.crater) {
      const double dx = (best->x - c.x) / c.diameter, dy = (best->y - c.y) / c.diameter;
      e.along = static_cast<float>(dx * cosine + dy * sine);
      e.across = static_cast<float>(dy * cosine - dx * sine);
      e.log_size = static_cast<float>(std::log(best->diameter / c.diameter));
    }
    examples.push_back(e);
  }
  return examples;
}

ConvolutionNet train_patch_network(std::span<const WidePatchExample> examples, int rounds, std::uint64_t seed,
                                   const std::function<void(int, double)>& progress) {
  constexpr std::size_t batch = 64;
  constexpr double rate = 2e-3, decay = 0.01;
  Random random(seed, "training of looks");
  ConvolutionTrainer learner(untrained_network(), random);
  std::vector<std::size_t> order(examples.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const double all_steps = double(rounds) * double(order.size() / batch + 1);
  int steps = 0;
  std::array<float, 4> slope{};
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.uniform_index(i)]);
    double loss = 0;
    for (std::size_t begin = 0; begin < order.size(); begin += batch) {
      const std::size_t end = std::min(begin + batch, order.size());
      for (std::size_t i = begin; i < end; ++i) {
        const WidePatchExample& example = examples[order[i]];
        const bool mirror = random.bernoulli(0.5);
        WidePatch wide = mirror ? mirror_patch(example.wide) : example.wide;
        if (random.bernoulli(0.5)) jitter_tones(wide, random);
        loss += loss_gradient(learner.forward(wide.patch, wide.scalars), example, mirror, slope);
        learner.backward(slope);
      }
      ++steps;
      const double cooling = 0.5 * (1 + std::cos(std::numbers::pi * steps / all_steps));
      learner.step(rate * cooling * std::min(1.0, steps / 200.0), decay, double(end - begin));
    }
    if (progress) progress(round, loss / double(std::max<std::size_t>(1, order.size())));
  }
  return learner.net();
}

}  // namespace waymark::pipeline
