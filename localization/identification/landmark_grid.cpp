// SPDX-License-Identifier: Apache-2.0
#include "localization/identification/landmark_grid.hpp"

#include <algorithm>
#include <numeric>

#include "core/covariance.hpp"

namespace waymark::localization {

LandmarkGrid::LandmarkGrid(std::vector<MapLandmark> landmarks, double cell) {
  std::erase_if(landmarks, [](const MapLandmark& l) { return !l.at.allFinite(); });
  if (landmarks.empty()) return;
  for (const MapLandmark& landmark : landmarks) {
    bounds_.extend(landmark.at);
    largest_sd_ = std::max(largest_sd_, core::largest_sd(landmark.covariance));
    max_half_length_ = std::max(max_half_length_, landmark.half_length);
    min_quality_ = std::min(min_quality_, landmark.paper_quality);
  }
  const Eigen::Vector2d size = bounds_.sizes();
  const double count = static_cast<double>(landmarks.size());
  if (!(cell > 0)) cell = std::max(std::sqrt(size.prod() / count * 2), size.maxCoeff() / (count + 1));
  cell_ = std::max({cell, size.maxCoeff() / 60000, 1e-3});
  while (size.prod() / (cell_ * cell_) > 8 * count + 64) cell_ *= 1.5;
  columns_ = static_cast<std::int64_t>(size.x() / cell_) + 1;
  rows_ = static_cast<std::int64_t>(size.y() / cell_) + 1;

  std::vector<std::uint32_t> cell_of(landmarks.size());
  first_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const Eigen::Vector2d in = (landmarks[i].at - bounds_.min()) / cell_;
    cell_of[i] = static_cast<std::uint32_t>(static_cast<std::int64_t>(in.y()) * columns_ +
                                            static_cast<std::int64_t>(in.x()));
    ++first_[cell_of[i] + 1];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  landmarks_.resize(landmarks.size());
  at_.resize(landmarks.size());
  by_key_.reserve(landmarks.size());
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const std::uint32_t to = next[cell_of[i]]++;
    landmarks_[to] = landmarks[i];
    at_[to] = {landmarks[i].at.x(), landmarks[i].at.y()};
    by_key_.emplace(landmarks[i].key, to);
  }
  mark_outweighed();
}

void LandmarkGrid::mark_outweighed() {
  for (MapLandmark& l : landmarks_) {
    l.outweighed = false;
    if (!l.is_doubtful()) continue;
    double likely = 0, doubtful = 0;
    near(l.at, kOutweighedRadius, [&](std::uint32_t i) {
      const MapLandmark& other = landmarks_[i];
      if (other.type == l.type) (other.quality < kLikelyExistence ? doubtful : likely) += other.quality;
    });
    l.outweighed = likely > doubtful;
  }
}

std::optional<std::uint32_t> LandmarkGrid::find(LandmarkKey key) const {
  const auto found = by_key_.find(key);
  if (found == by_key_.end()) return {};
  return found->second;
}

}  // namespace waymark::localization
