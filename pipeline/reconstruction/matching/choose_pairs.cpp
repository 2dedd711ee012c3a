// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/matching/choose_pairs.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <set>

#include "pipeline/reconstruction/matching/match_features.hpp"

namespace waymark::pipeline {
namespace {

struct Ranked {
  double rank = 0;  // smaller is better
  std::size_t other = 0;
  friend auto operator<=>(const Ranked&, const Ranked&) = default;
};

void add_pair(std::set<ImagePair>& pairs, std::size_t a, std::size_t b) {
  if (a != b) pairs.insert({std::min(a, b), std::max(a, b)});
}

void add_near(std::span<const std::optional<Eigen::Vector3d>> positions, std::size_t count,
              std::set<ImagePair>& pairs) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!positions[i]) continue;
    std::vector<Ranked> others;
    for (std::size_t j = 0; j < positions.size(); ++j)
      if (j != i && positions[j]) others.push_back({(*positions[i] - *positions[j]).norm(), j});
    std::ranges::sort(others);
    for (std::size_t k = 0; k < std::min(count, others.size()); ++k) add_pair(pairs, i, others[k].other);
  }
}

void add_promising(std::span<const ImageFeatures> images, const PairChoice& choice,
                   std::set<ImagePair>& pairs) {
  const std::size_t n = images.size();
  std::vector<std::size_t> counts(n * n, 0);
  tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) {
    for (std::size_t j = i + 1; j < n; ++j)
      counts[i * n + j] = counts[j * n + i] =
          match_features(images[i], images[j], {.limit = choice.preview}).size();
  });
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<Ranked> others;
    for (std::size_t j = 0; j < n; ++j)
      if (j != i) others.push_back({-double(counts[i * n + j]), j});
    std::ranges::sort(others);
    for (std::size_t k = 0; k < std::min(choice.max_pairs, others.size()); ++k)
      if (k < choice.best || -others[k].rank >= double(choice.min_preview))
        add_pair(pairs, i, others[k].other);
  }
}

}  // namespace

std::vector<ImagePair> choose_pairs(std::span<const ImageFeatures> images,
                                    std::span<const std::optional<Eigen::Vector3d>> positions,
                                    const PairChoice& choice) {
  std::set<ImagePair> pairs;
  const std::size_t n = images.size();
  if (n <= choice.all_below) {
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j) add_pair(pairs, i, j);
    return {pairs.begin(), pairs.end()};
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < std::min(n, i + 1 + choice.sequence); ++j) add_pair(pairs, i, j);
  add_near(positions, choice.near, pairs);
  add_promising(images, choice, pairs);
  return {pairs.begin(), pairs.end()};
}

}  // namespace waymark::pipeline
