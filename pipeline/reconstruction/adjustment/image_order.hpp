// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>
#include <vector>
#include "pipeline/reconstruction/reconstruction.hpp"
namespace waymark::pipeline {

/// Order of images that depends on their names only: an adjustment gives the same bytes for any order of
/// files.
class ImageOrder {
 public:
  explicit ImageOrder(const Reconstruction& scene);

  /// Returns the images in their order.
  const std::vector<std::size_t>& images() const { return images_; }
  std::size_t rank(std::size_t image) const { return rank_[image]; }

  /// Returns the indices of observations, which have a member `image`, in the order of their images.
  template <class Observation>
  std::vector<std::size_t> sort(const std::vector<Observation>& all) const {
    std::vector<std::size_t> order(all.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return rank_[all[i].image]; });
    return order;
  }

 private:
  std::vector<std::size_t> images_ = {}, rank_ = {};
};

/// Mark in a posed image, as it is ordered.
struct RankedMark {
  std::size_t rank = 0, index = 0;  ///< of the image, and in the point
  double x = 0, y = 0;
  auto key() const { return std::tuple(rank, x, y); }
};

/// Returns the marks of a point in posed images, in the order of the images.
std::vector<RankedMark> ranked_marks(const std::vector<Mark>& marks, const Reconstruction& scene,
                                     const ImageOrder& order);

}  // namespace waymark::pipeline
