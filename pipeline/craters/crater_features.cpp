// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/crater_features.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "pipeline/craters/bowl_template.hpp"
#include "pipeline/craters/pixel_noise.hpp"
#include "pipeline/craters/sample.hpp"

namespace waymark::pipeline {
namespace {

using Patch = std::array<float, kPatchSide * kPatchSide>;

// Zero mean, unit deviation, clipped to 3; returns the deviation.
double normalise_patch(Patch& patch) {
  double sum = 0, squares = 0;
  for (const float v : patch) sum += v;
  const double mean = sum / double(patch.size());
  for (const float v : patch) squares += (v - mean) * (v - mean);
  const double deviation = std::sqrt(squares / double(patch.size()));
  const double scale = deviation > 0 ? 1 / deviation : 0;
  for (float& v : patch) v = static_cast<float>(std::clamp((v - mean) * scale, -3.0, 3.0));
  return deviation;
}

void thumbnail(const Patch& patch, float* out) {
  for (int y = 0; y < kThumbSide; ++y)
    for (int x = 0; x < kThumbSide; ++x) {
      const float* p = patch.data() + 2 * y * kPatchSide + 2 * x;
      *out++ = (p[0] + p[1] + p[kPatchSide] + p[kPatchSide + 1]) / 4;
    }
}

// Signed directions, interpolated between two bins; one block of norm 1, clipped at 0.25 and scaled to ~1.
void gradients(const Patch& patch, float* out) {
  std::array<float, kHogCells * kHogCells * kHogBins> cells{};
  constexpr int cell_side = kPatchSide / kHogCells;
  for (int y = 0; y < kPatchSide; ++y)
    for (int x = 0; x < kPatchSide; ++x) {
      const auto at = [&](int i, int j) {
        return patch[static_cast<std::size_t>(std::clamp(j, 0, kPatchSide - 1) * kPatchSide +
                                              std::clamp(i, 0, kPatchSide - 1))];
      };
      const float gx = at(x + 1, y) - at(x - 1, y), gy = at(x, y + 1) - at(x, y - 1);
      const float strength = std::sqrt(gx * gx + gy * gy);
      if (!(strength > 0)) continue;
      const float turn = std::atan2(gy, gx) / static_cast<float>(2 * std::numbers::pi) + 0.5F;
      const float place = turn * kHogBins;
      const int bin = static_cast<int>(place);
      const float part = place - static_cast<float>(bin);
      float* cell = cells.data() + (y / cell_side * kHogCells + x / cell_side) * kHogBins;
      cell[bin % kHogBins] += strength * (1 - part);
      cell[(bin + 1) % kHogBins] += strength * part;
    }
  float squares = 1e-6F;
  for (const float v : cells) squares += v * v;
  const float scale = 1 / std::sqrt(squares);
  for (const float v : cells) *out++ = 4 * std::min(0.25F, v * scale);
}

struct BowlSample {
  std::size_t index;  // in the patch
  double bowl;        // brightness of the template
};

std::vector<BowlSample> sampled_bowl(BowlLight light) {
  constexpr double step = 2 * kPatchReach / kPatchSide;  // radii between samples
  std::vector<BowlSample> samples;
  for (int j = 0; j < kPatchSide; ++j)
    for (int i = 0; i < kPatchSide; ++i) {
      const double u = (i - (kPatchSide - 1) / 2.0) * step, v = (j - (kPatchSide - 1) / 2.0) * step;
      if (std::max(std::abs(u), std::abs(v)) > 1.35) continue;
      samples.push_back({static_cast<std::size_t>(j * kPatchSide + i), bowl_brightness(u, v, light)});
    }
  return samples;
}

double correlation(const std::array<float, kPatchSide * kPatchSide>& seen,
                   const std::vector<BowlSample>& bowl) {
  double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (const BowlSample& at : bowl) {
    const double value = seen[at.index];
    a += value, b += at.bowl, aa += value * value, bb += at.bowl * at.bowl, ab += value * at.bowl;
  }
  const auto n = double(bowl.size());
  const double spread = (aa - a * a / n) * (bb - b * b / n);
  return spread > 0 ? (ab - a * b / n) / std::sqrt(spread) : 0;
}

const std::vector<BowlSample>& sampled_slope() {
  static const std::vector<BowlSample> bowl = sampled_bowl(BowlLight::slope);
  return bowl;
}

}  // namespace

double normalise(std::array<float, kWidePatchSide * kWidePatchSide>& patch) {
  // Samples entirely within 1.6 radii of the centre.
  constexpr int margin = 3, inner = kWidePatchSide - 2 * margin;
  static_assert(2 * 1.6 / (2 * kWidePatchReach / kWidePatchSide) < inner &&
                inner - 2 < 2 * 1.6 / (2 * kWidePatchReach / kWidePatchSide));
  double sum = 0, squares = 0;
  const auto over_inner = [&](const auto& add) {
    for (int j = margin; j < kWidePatchSide - margin; ++j)
      for (int i = margin; i < kWidePatchSide - margin; ++i)
        add(double(patch[static_cast<std::size_t>(j * kWidePatchSide + i)]));
  };
  over_inner([&](double v) { sum += v; });
  const double mean = sum / (inner * inner);
  over_inner([&](double v) { squares += (v - mean) * (v - mean); });
  const double deviation = std::sqrt(squares / (inner * inner)), scale = deviation > 0 ? 1 / deviation : 0;
  for (float& v : patch) v = static_cast<float>(std::clamp((v - mean) * scale, -3.0, 3.0));
  return deviation;
}

PatchSource::PatchSource(const Pixels& image, Radians sun_angle) : sun_angle_(sun_angle) {
  auto levels = std::make_shared<std::vector<Level>>();
  levels->push_back({image, 1, 1});
  noise_ = std::max(1e-12, pixel_noise(image.cells().data(), static_cast<int>(image.columns()),
                                       static_cast<int>(image.rows())));
  while (std::min(levels->back().pixels.columns(), levels->back().pixels.rows()) >= 16) {
    Pixels& fine = levels->back().pixels;
    const cv::Mat1f from(static_cast<int>(fine.rows()), static_cast<int>(fine.columns()),
                         fine.cells().data());
    Pixels half((fine.columns() + 1) / 2, (fine.rows() + 1) / 2);
    cv::Mat1f to(static_cast<int>(half.rows()), static_cast<int>(half.columns()), half.cells().data());
    cv::resize(from, to, to.size(), 0, 0, cv::INTER_AREA);
    const double shrink_x = double(image.columns()) / double(half.columns()),
                 shrink_y = double(image.rows()) / double(half.rows());
    levels->push_back({std::move(half), shrink_x, shrink_y});
  }
  levels_ = std::move(levels);
}

template <int kSide>
void PatchSource::read(const CraterCandidate& c, double reach, bool mirrored, float* samples) const {
  const double step = reach * c.diameter / kSide;  // pixels of the image between samples
  const auto wanted = static_cast<int>(std::floor(std::log2(std::max(1.0, step / 0.75))));
  const Level& level = (*levels_)[std::min(static_cast<std::size_t>(wanted), levels_->size() - 1)];
  // From here on in pixels of the level.
  const double x = (c.x + 0.5) / level.shrink_x - 0.5, y = (c.y + 0.5) / level.shrink_y - 0.5;
  const double cosine = std::cos(sun_angle_.value) * step, sine = std::sin(sun_angle_.value) * step;
  const double u_x = cosine / level.shrink_x, u_y = sine / level.shrink_y;
  const double v_x = (mirrored ? 1 : -1) * sine / level.shrink_x,
               v_y = (mirrored ? -1 : 1) * cosine / level.shrink_y;
  constexpr double middle = (kSide - 1) / 2.0;
  const bool inside =
      is_inside(level.pixels, x, y, 1.5 * step / std::min(level.shrink_x, level.shrink_y) * middle);
  const float* const pixels = level.pixels.cells().data();
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const double u = i - middle, v = j - middle;
      const double at_x = x + u * u_x + v * v_x, at_y = y + u * u_y + v * v_y;
      *samples++ = inside ? sample_inside(pixels, level.pixels.columns(), at_x, at_y)
                          : sample(level.pixels, at_x, at_y);
    }
}

std::array<float, kPatchSide * kPatchSide> PatchSource::patch(const CraterCandidate& c, bool mirrored) const {
  Patch patch{};
  read<kPatchSide>(c, kPatchReach, mirrored, patch.data());
  return patch;
}

std::array<float, 3> PatchSource::scalar_inputs(double correlation, double deviation, double diameter) const {
  return {static_cast<float>(4 * correlation - 2),
          static_cast<float>(std::clamp(std::log2((deviation + 1e-12) / noise_) / 3, -1.0, 2.0)),
          static_cast<float>(std::clamp(std::log2(diameter / 12), -1.0, 1.0))};
}

CraterFeatures PatchSource::features(const CraterCandidate& c, double correlation, bool mirrored) const {
  CraterFeatures result{};
  Patch seen = patch(c, mirrored);
  const double deviation = normalise_patch(seen);
  thumbnail(seen, result.data());
  gradients(seen, result.data() + kThumbSide * kThumbSide);
  const auto rest = scalar_inputs(correlation, deviation, c.diameter);
  std::copy(rest.begin(), rest.end(), result.end() - 3);
  return result;
}

WidePatch PatchSource::wide_patch(const CraterCandidate& c, double correlation) const {
  WidePatch wide;
  read<kWidePatchSide>(c, kWidePatchReach, false, wide.patch.data());
  wide.scalars = scalar_inputs(correlation, normalise(wide.patch), c.diameter);
  return wide;
}

double PatchSource::slope_correlation(const CraterCandidate& c) const {
  return correlation(patch(c), sampled_slope());
}

double PatchSource::bowl_correlation(const CraterCandidate& c) const {
  constexpr double kMinFilled = 20;  // pixels
  static const std::array filled{sampled_bowl(BowlLight::flat_floor), sampled_bowl(BowlLight::rim_only)};
  const auto seen = patch(c);
  double best = correlation(seen, sampled_slope());
  if (c.diameter >= kMinFilled)
    for (const auto& bowl : filled) best = std::max(best, correlation(seen, bowl));
  return best;
}

}  // namespace waymark::pipeline
