// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/matching/match_features.hpp"

#include <Eigen/Core>
#include <algorithm>

namespace waymark::pipeline {
namespace {

using DescriptorMatrix = Eigen::Matrix<float, 128, Eigen::Dynamic>;
constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();
constexpr Eigen::Index kDescriptorBlock = 128;  // descriptors of the second image per product

// Squared distances below 2^24 are exact.
struct Nearest {
  float best = std::numeric_limits<float>::infinity(), second = std::numeric_limits<float>::infinity();
  std::uint32_t index = kNobody;
};

DescriptorMatrix matrix_of(const ImageFeatures& image, std::size_t limit) {
  const std::size_t count = std::min(limit, image.descriptors.size());
  DescriptorMatrix all(128, static_cast<Eigen::Index>(count));
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < 128; ++k)
      all(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) = image.descriptors[i][k];
  return all;
}

// A tie keeps the smaller index.
void offer(Nearest& nearest, float distance, std::uint32_t index, const std::vector<Feature>& features) {
  const bool same_place = nearest.index != kNobody && features[nearest.index].pixel == features[index].pixel;
  if (distance < nearest.best) {
    if (!same_place) nearest.second = nearest.best;
    nearest.best = distance;
    nearest.index = index;
  } else if (distance < nearest.second && !same_place) {
    nearest.second = distance;
  }
}

}  // namespace

std::vector<Match> match_features(const ImageFeatures& first, const ImageFeatures& second,
                                  const MatchSettings& settings) {
  const DescriptorMatrix a = matrix_of(first, settings.limit), b = matrix_of(second, settings.limit);
  std::vector<Match> matches;
  if (a.cols() < 2 || b.cols() < 2) return matches;
  const Eigen::VectorXf a2 = a.colwise().squaredNorm(), b2 = b.colwise().squaredNorm();
  std::vector<Nearest> of_a(static_cast<std::size_t>(a.cols())), of_b(static_cast<std::size_t>(b.cols()));
  Eigen::MatrixXf products;
  for (Eigen::Index from = 0; from < b.cols(); from += kDescriptorBlock) {
    const Eigen::Index count = std::min(kDescriptorBlock, b.cols() - from);
    products.noalias() = a.transpose() * b.middleCols(from, count);
    for (Eigen::Index j = 0; j < count; ++j) {
      Nearest& nearest_b = of_b[static_cast<std::size_t>(from + j)];
      const float square = b2[from + j];
      for (Eigen::Index i = 0; i < a.cols(); ++i) {
        const float distance = a2[i] + square - 2 * products(i, j);
        Nearest& nearest_a = of_a[static_cast<std::size_t>(i)];
        if (distance < nearest_b.second)
          offer(nearest_b, distance, static_cast<std::uint32_t>(i), first.features);
        if (distance < nearest_a.second)
          offer(nearest_a, distance, static_cast<std::uint32_t>(from + j), second.features);
      }
    }
  }
  const auto square = static_cast<float>(settings.ratio * settings.ratio);
  const auto clear = [&](const Nearest& n) { return n.index != kNobody && n.best < square * n.second; };
  for (std::size_t i = 0; i < of_a.size(); ++i)
    if (clear(of_a[i]) && clear(of_b[of_a[i].index]) && of_b[of_a[i].index].index == i)
      matches.push_back({static_cast<std::uint32_t>(i), of_a[i].index});
  return matches;
}

}  // namespace waymark::pipeline
