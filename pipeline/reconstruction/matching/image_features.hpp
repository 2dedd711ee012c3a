// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>
#include "geo/image_source.hpp"
namespace waymark::pipeline {

/// Distinct point of an image.
struct Feature {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double scale = 0;  ///< standard deviation of the blob, pixels
  double angle = 0;  ///< of the dominant gradient, degrees from x (right) towards y (down)

  friend bool operator==(const Feature&, const Feature&) = default;
};

/// RootSIFT: square roots of the normalised histogram, times 512. Its Euclidean length is 512.
using Descriptor = std::array<std::uint8_t, 128>;

/// Features of an image and their descriptors, the largest scale first.
struct ImageFeatures {
  std::vector<Feature> features = {};
  std::vector<Descriptor> descriptors = {};

  friend bool operator==(const ImageFeatures&, const ImageFeatures&) = default;
};

struct FeatureSettings {
  double density = 2e-3;  ///< features per pixel: 4000 in 2 megapixels
  double saturated = 0;   ///< brightness from which pixels are saturated; 0: unknown
};

/// Finds SIFT features (Lowe 2004) and describes them by RootSIFT (Arandjelovic & Zisserman 2012).
/// - Features are spread over cells of a grid: each cell gives its strongest ones in turn.
/// - Places are corrected for the shift of 0.25 px of OpenCV 4.6 (issue 23123).
/// - A feature is dropped if more than a third of its surroundings is saturated or black, or if pixels
///   without data are near it.
/// - Images above 2.5 megapixels are searched in tiles, and for large features at a quarter of their size.
/// Uses one thread; 0.6 s and 250 MB per megapixel of a tile.
ImageFeatures find_features(const Pixels& image, const FeatureSettings& settings);

}  // namespace waymark::pipeline
