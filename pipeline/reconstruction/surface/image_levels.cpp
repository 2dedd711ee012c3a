// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/image_levels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "pipeline/vision/half_image.hpp"

namespace waymark::pipeline {
namespace {

std::size_t bytes_of(const ImageLevel& level) {
  return level.pixels.cells().size() * sizeof(float);
}

}  // namespace

float sample_level(const ImageLevel& image, double x, double y) {
  const Pixels& p = image.pixels;
  if (!(x >= 0 && y >= 0 && x <= double(p.columns() - 1) && y <= double(p.rows() - 1)))
    return std::numeric_limits<float>::quiet_NaN();
  const auto i = std::min(static_cast<std::int64_t>(x), p.columns() - 2);
  const auto j = std::min(static_cast<std::int64_t>(y), p.rows() - 2);
  const double a = x - double(i), b = y - double(j);
  const auto at = [&](std::int64_t c, std::int64_t r) { return static_cast<double>(p(c, r)); };
  return static_cast<float>((1 - b) * ((1 - a) * at(i, j) + a * at(i + 1, j)) +
                            b * ((1 - a) * at(i, j + 1) + a * at(i + 1, j + 1)));
}

double noise_of(const Pixels& image, int level) {
  constexpr std::int64_t kBlock = 16;
  std::vector<float> blocks, differences;
  for (std::int64_t r0 = 1; r0 + kBlock < image.rows(); r0 += kBlock)
    for (std::int64_t c0 = 1; c0 + kBlock < image.columns(); c0 += kBlock) {
      differences.clear();
      for (std::int64_t r = r0; r < r0 + kBlock; r += 2)
        for (std::int64_t c = c0; c < c0 + kBlock; c += 2) {
          const float corners =
              image(c - 1, r - 1) + image(c + 1, r - 1) + image(c - 1, r + 1) + image(c + 1, r + 1);
          const float sides = image(c, r - 1) + image(c - 1, r) + image(c + 1, r) + image(c, r + 1);
          const float d = std::abs(corners - 2 * sides + 4 * image(c, r));
          if (std::isfinite(d)) differences.push_back(d);
        }
      if (differences.size() < 32) continue;
      const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
      std::nth_element(differences.begin(), middle, differences.end());
      blocks.push_back(*middle);
    }
  const double floor = 0.3 / static_cast<double>(1 << level);
  if (blocks.empty()) return floor;
  const auto low = blocks.begin() + static_cast<std::ptrdiff_t>(blocks.size() / 10);
  std::nth_element(blocks.begin(), low, blocks.end());
  return std::max(floor, 1.4826 * static_cast<double>(*low) / 6);  // the mask's norm is 6
}

ImageLevels::ImageLevels(const std::vector<SurfaceView>& views, std::size_t budget_bytes)
    : views_(views), budget_(budget_bytes) {
  for (std::size_t i = 0; i < views.size(); ++i) reading_.push_back(std::make_unique<std::mutex>());
}

std::shared_ptr<const ImageLevel> ImageLevels::get(std::size_t view, int level) {
  if (auto known = find({view, level})) return known;
  const std::lock_guard one_reader(*reading_[view]);
  if (auto known = find({view, level})) return known;
  int from = level - 1;
  std::shared_ptr<const ImageLevel> image;
  while (from >= 0 && !(image = find({view, from}))) --from;
  if (!image) {
    const ImageInfo& info = views_[view].image->info();
    ImageLevel first{views_[view].image->read({0, 0, info.columns, info.rows}), 0};
    first.noise = noise_of(first.pixels, 0);
    image = std::make_shared<const ImageLevel>(std::move(first));
    keep({view, 0}, image);
    from = 0;
  }
  for (; from < level; ++from) {
    ImageLevel next{half_image(image->pixels), 0};
    next.noise = noise_of(next.pixels, from + 1);
    image = std::make_shared<const ImageLevel>(std::move(next));
    keep({view, from + 1}, image);
  }
  return image;
}

std::shared_ptr<const ImageLevel> ImageLevels::find(const Key& key) {
  const std::lock_guard lock(mutex_);
  const auto entry = entries_.find(key);
  if (entry == entries_.end()) return nullptr;
  order_.splice(order_.begin(), order_, entry->second.used);
  return entry->second.image;
}

void ImageLevels::keep(const Key& key, std::shared_ptr<const ImageLevel> image) {
  const std::lock_guard lock(mutex_);
  if (entries_.contains(key)) return;
  bytes_ += bytes_of(*image);
  order_.push_front(key);
  entries_[key] = {std::move(image), order_.begin()};
  while (bytes_ > budget_ && order_.size() > 1) {
    const auto last = entries_.find(order_.back());
    bytes_ -= bytes_of(*last->second.image);
    entries_.erase(last);
    order_.pop_back();
  }
}

}  // namespace waymark::pipeline
