// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/robust_similarity.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/solve.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kLimit = 3;            // standard deviations of a pair that agrees
constexpr double kBeside = 3;           // standard deviations, root mean square, from a line
constexpr std::size_t kTrials = 10000;  // subsets tried at most

RobustSimilarity judged(const Similarity& similarity, const std::vector<PositionPair>& pairs) {
  RobustSimilarity out{similarity};
  for (const PositionPair& pair : pairs) {
    const double miss = (similarity * pair.frame - pair.map).norm() / pair.sd;
    out.agrees.push_back(miss < kLimit);
    out.score += std::min(miss * miss, kLimit * kLimit);
  }
  return out;
}

std::vector<PositionPair> agreeing(const RobustSimilarity& found, const std::vector<PositionPair>& pairs) {
  std::vector<PositionPair> out;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (found.agrees[i]) out.push_back(pairs[i]);
  return out;
}

// Similarity by least squares with weights 1 / sd^2 (Umeyama 1991); with `level`, z stays vertical.
std::optional<Similarity> fit(const std::vector<PositionPair>& pairs, bool level) {
  double total = 0;
  Eigen::Vector3d frame = Eigen::Vector3d::Zero(), map = frame;
  for (const PositionPair& p : pairs) {
    const double weight = 1 / (p.sd * p.sd);
    total += weight;
    frame += weight * p.frame;
    map += weight * p.map;
  }
  frame /= total;
  map /= total;
  Eigen::Matrix3d product = Eigen::Matrix3d::Zero();
  double spread = 0;
  for (const PositionPair& p : pairs) {
    const double weight = 1 / (p.sd * p.sd) / total;
    product += weight * (p.map - map) * (p.frame - frame).transpose();
    spread += weight * (p.frame - frame).squaredNorm();
  }
  Similarity out;
  if (level) {
    const double sine = product(1, 0) - product(0, 1), cosine = product(0, 0) + product(1, 1);
    if (!(std::hypot(sine, cosine) > 0)) return std::nullopt;
    out.rotation = Eigen::AngleAxisd(std::atan2(sine, cosine), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  } else {
    const SingularValues3 parts = singular_values(product);
    Eigen::Vector3d sign(1, 1, 1);
    if (parts.u.determinant() * parts.v.determinant() < 0) sign.z() = -1;
    out.rotation = parts.u * sign.asDiagonal() * parts.v.transpose();
  }
  out.scale = (out.rotation.transpose() * product).trace() / spread;
  if (!(out.scale > 0) || !std::isfinite(out.scale)) return std::nullopt;
  out.shift = map - out.scale * (out.rotation * frame);
  return out;
}

// Least squares over the pairs that agree, until they stay the same.
RobustSimilarity refined(RobustSimilarity found, const std::vector<PositionPair>& pairs, bool level) {
  for (int round = 0; round < 10; ++round) {
    const auto next = fit(agreeing(found, pairs), level);
    if (!next) return found;
    RobustSimilarity better = judged(*next, pairs);
    if (better.score > found.score) return found;
    const bool same = better.agrees == found.agrees;
    found = std::move(better);
    if (same) break;
  }
  return found;
}

double distance_in_plan(const std::vector<PositionPair>& pairs) {
  double largest = 0;
  for (const PositionPair& p : pairs)
    largest = std::max(largest, (p.map - pairs.front().map).head<2>().norm());
  return largest;
}

double largest_sd(const std::vector<PositionPair>& pairs) {
  double largest = 0;
  for (const PositionPair& p : pairs) largest = std::max(largest, p.sd);
  return largest;
}

}  // namespace

double distance_from_line(const std::vector<PositionPair>& pairs) {
  if (pairs.size() < 3) return 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const PositionPair& p : pairs) mean += p.map / static_cast<double>(pairs.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const PositionPair& p : pairs) spread += (p.map - mean) * (p.map - mean).transpose();
  const Eigen::Vector3d axes = symmetric_eigen(spread).values;
  return std::sqrt(std::max(0.0, axes[0] + axes[1]) / static_cast<double>(pairs.size()));
}

std::optional<RobustSimilarity> robust_similarity(const std::vector<PositionPair>& pairs) {
  const std::size_t n = pairs.size();
  if (n < 3) return std::nullopt;
  const std::size_t all = n * (n - 1) * (n - 2) / 6, stride = all / kTrials + 1;
  std::optional<RobustSimilarity> best;
  std::size_t number = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      for (std::size_t k = j + 1; k < n; ++k) {
        if (number++ % stride != 0) continue;
        const std::vector<PositionPair> triple{pairs[i], pairs[j], pairs[k]};
        if (!(distance_from_line(triple) > largest_sd(triple))) continue;
        const auto similarity = fit(triple, false);
        if (!similarity) continue;
        RobustSimilarity found = judged(*similarity, pairs);
        if (!best || found.score < best->score) best = std::move(found);
      }
  if (!best) return std::nullopt;
  best = refined(*best, pairs, false);
  const auto used = agreeing(*best, pairs);
  // Errors alone spread positions on a line by sqrt(2) standard deviations across it.
  if (used.size() < 3 || !(distance_from_line(used) > kBeside * largest_sd(used))) return std::nullopt;
  return best;
}

std::optional<RobustSimilarity> robust_similarity(const std::vector<PositionPair>& pairs,
                                                  const Eigen::Vector3d& up_in_frame) {
  const std::size_t n = pairs.size();
  if (n < 2) return std::nullopt;
  const Eigen::Matrix3d level = rotation_between(up_in_frame, Eigen::Vector3d::UnitZ());
  std::vector<PositionPair> levelled = pairs;
  for (PositionPair& p : levelled) p.frame = level * p.frame;
  std::optional<RobustSimilarity> best;
  const std::size_t stride = n * (n - 1) / 2 / kTrials + 1;
  std::size_t number = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) {
      if (number++ % stride != 0) continue;
      const std::vector<PositionPair> couple{levelled[i], levelled[j]};
      if (!(distance_in_plan(couple) > largest_sd(couple))) continue;
      const auto similarity = fit(couple, true);
      if (!similarity) continue;
      RobustSimilarity found = judged(*similarity, levelled);
      if (!best || found.score < best->score) best = std::move(found);
    }
  if (!best) return std::nullopt;
  best = refined(*best, levelled, true);
  if (agreeing(*best, levelled).size() < 2) return std::nullopt;
  best->map_from_frame.rotation = best->map_from_frame.rotation * level;
  return best;
}

}  // namespace waymark::pipeline
