// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>
#include "pipeline/reconstruction/matching/image_features.hpp"
namespace waymark::pipeline {

/// Two images to be matched; first < second.
struct ImagePair {
  std::size_t first = 0, second = 0;
  friend auto operator<=>(const ImagePair&, const ImagePair&) = default;
};

struct PairChoice {
  std::size_t all_below = 9;     ///< image count up to which all pairs are matched
  std::size_t preview = 300;     ///< features of largest scale that are matched between all images
  std::size_t min_preview = 10;  ///< matches of a preview from which a pair is promising
  std::size_t best = 4;          ///< pairs of most preview matches that each image has in any case
  std::size_t sequence = 2;      ///< following images by name that each image is matched with
  std::size_t near = 8;          ///< nearest images by position that each image is matched with
  std::size_t max_pairs = 24;    ///< promising pairs per image, best first
};

/// Chooses the pairs worth matching in full, sorted. A union, since any source may fail: sequence by name,
/// neighbours by `positions` (metres; `std::nullopt` where unknown), previews. In parallel; previews take
/// 2 ms per pair.
std::vector<ImagePair> choose_pairs(std::span<const ImageFeatures> images,
                                    std::span<const std::optional<Eigen::Vector3d>> positions,
                                    const PairChoice& choice);

}  // namespace waymark::pipeline
