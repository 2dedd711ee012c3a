// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <vector>
#include "pipeline/reconstruction/surface/surface_view.hpp"
namespace waymark::pipeline {

/// Image reduced by 2^level: pixel x of level 0 lies at (x + 0.5) / 2^level - 0.5.
struct ImageLevel {
  Pixels pixels;
  double noise = 0;  ///< standard deviation of the noise of a pixel
};

/// Returns the bilinear brightness at a pixel of the level; NaN outside and beside pixels without data.
float sample_level(const ImageLevel& image, double x, double y);

/// Returns the standard deviation of pixel noise: the lower decile over blocks of 16 x 16 of the robust
/// second mixed difference (Immerkaer 1996). At least 0.3, the rounding of integers, reduced by 2^level.
double noise_of(const Pixels& image, int level);

/// Pyramids of images, computed when first used. Least recently used levels are dropped beyond a budget,
/// which changes the time and nothing else. Thread-safe.
class ImageLevels {
 public:
  ImageLevels(const std::vector<SurfaceView>& views, std::size_t budget_bytes);

  /// Returns a level; throws Error{input} if the image cannot be read.
  std::shared_ptr<const ImageLevel> get(std::size_t view, int level);

 private:
  struct Key {
    std::size_t view;
    int level;
    auto operator<=>(const Key&) const = default;
  };
  struct Entry {
    std::shared_ptr<const ImageLevel> image;
    std::list<Key>::iterator used;
  };
  std::shared_ptr<const ImageLevel> find(const Key& key);
  void keep(const Key& key, std::shared_ptr<const ImageLevel> image);

  const std::vector<SurfaceView>& views_;
  std::size_t budget_, bytes_ = 0;
  std::mutex mutex_;
  std::vector<std::unique_ptr<std::mutex>> reading_;  ///< one per image
  std::map<Key, Entry> entries_;
  std::list<Key> order_;  ///< most recently used first
};

}  // namespace waymark::pipeline
