// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/slam_association.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "localization/chi_square.hpp"

namespace waymark::localization {
namespace {

constexpr double kJointGate = 0.999;  // probability that right pairs of a set agree
constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Returns the squared distance of the features less its mean; infinite if they exclude each other.
double feature_distance(const SeenLandmark& seen, const SlamLandmark& landmark, const FeatureScales& scales,
                        const SlamOptions& options) {
  if (seen.may_be_anything() || !landmark.type) return 0;
  const KnownFeatures* const features = seen.features_as(*landmark.type);
  if (!features) return kInfinite;
  const FeatureComparison c =
      compare_features(scales, *landmark.type, *features, landmark.features, options.feature_tolerance);
  return c.largest > options.feature_limit ? kInfinite : c.squares - c.used;
}

// Returns whether a sighting without an identity may show a landmark, as far as identities say.
bool may_be_shown(const SeenLandmark& seen, const SlamLandmark& landmark, const SlamOptions& options) {
  if (landmark.was_mapped) return true;
  if (options.identification.use_identities && landmark.key) return false;
  return seen.bearing.has_value();  // many landmarks may lie on the circle of a range
}

int measured_rows(const SeenLandmark& seen) {
  return seen.has_position() || seen.extent ? 2 : 1;
}

// Returns the squared Mahalanobis distance of a sighted line; `std::nullopt` if it lies beside the landmark
// or is of another type.
std::optional<double> line_squares(const SeenLandmark& seen, const SlamCandidate& candidate,
                                   const SlamLandmark& landmark) {
  if (!seen.extent || !candidate.extent || seen.type != landmark.type) return {};
  if (seen.extent->from > candidate.extent->to || seen.extent->to < candidate.extent->from) return {};
  const Eigen::Vector2d v = line_innovation(seen, *landmark.line, candidate.sighting.value);
  const Eigen::Matrix2d s = candidate.covariance + line_noise(seen, *landmark.line);
  return v.dot(s.inverse() * v);
}

}  // namespace

bool is_usable(const SeenLandmark& seen, const SlamOptions& options) {
  if (!seen.is_valid() || seen.type == kNoSuchType || (seen.extent && !seen.type)) return false;
  return !seen.range || *seen.range <= options.max_range || (!seen.bearing && is_identified(seen, options));
}

SlamPairs compare_with_landmarks(std::span<const SeenLandmark> seen,
                                 std::span<const SlamCandidate> candidates,
                                 std::span<const SlamLandmark> landmarks,
                                 std::span<const std::optional<LandmarkKey>> in_map,
                                 const FeatureScales& scales, const SlamOptions& options) {
  SlamPairs found{.pairs = {}, .comparisons = std::vector<SlamComparison>(seen.size())};
  for (const SlamCandidate& candidate : candidates) {
    const SlamLandmark& landmark = landmarks[candidate.landmark];
    for (std::size_t k = 0; k < seen.size(); ++k) {
      const SeenLandmark& s = seen[k];
      if (!is_usable(s, options)) continue;
      SlamComparison& comparison = found.comparisons[k];
      if (s.extent || landmark.line) {
        const std::optional<double> line = line_squares(s, candidate, landmark);
        if (!line) continue;
        comparison.min_squares = std::min(comparison.min_squares, *line);
        if (landmark.was_mapped && in_map[k] != landmark.key) continue;
        if (*line < options.match) found.pairs.push_back({*line, k, candidate.landmark});
        continue;
      }
      const Eigen::Vector2d v = innovation(s, candidate.sighting.value);
      const auto squares = [&] { return squared_distance(s, v, candidate.covariance + sensor_noise(s)); };
      if (is_identified(s, options)) {
        if (landmark.key != s.identity) continue;
        // An identity is accepted unless the landmark lies where it cannot be.
        comparison.min_squares = squares(), comparison.min_distance = 0;
        if (comparison.min_squares < options.fresh)
          found.pairs.push_back({comparison.min_squares, k, candidate.landmark});
        continue;
      }
      if (!may_be_shown(s, landmark, options)) continue;
      if (std::abs(v[0]) > 10 || std::abs(v[1]) > 1) continue;
      const double features = feature_distance(s, landmark, scales, options);
      if (std::isinf(features)) {
        comparison.features_differ = true;
        continue;
      }
      const double distance = std::hypot(v[0], v[1] * candidate.sighting.value[0]);
      const double position = squares();
      comparison.min_distance = std::min(comparison.min_distance, distance);
      comparison.min_squares = std::min(comparison.min_squares, position);
      if (landmark.was_mapped && in_map[k] != landmark.key) continue;
      if (position < options.match)
        found.pairs.push_back({position + std::max(features, 0.0), k, candidate.landmark});
    }
  }
  return found;
}

std::vector<SlamPair> pair_one_to_one(std::vector<SlamPair> pairs) {
  std::ranges::sort(pairs, {}, [](const SlamPair& p) { return std::tie(p.squares, p.sighting, p.landmark); });
  std::size_t sightings = 0, landmarks = 0;
  for (const SlamPair& p : pairs) {
    sightings = std::max(sightings, p.sighting + 1);
    landmarks = std::max(landmarks, p.landmark + 1);
  }
  std::vector<bool> is_sighting_used(sightings), is_landmark_used(landmarks);
  std::erase_if(pairs, [&](const SlamPair& p) {
    if (is_sighting_used[p.sighting] || is_landmark_used[p.landmark]) return true;
    is_sighting_used[p.sighting] = is_landmark_used[p.landmark] = true;
    return false;
  });
  return pairs;
}

void remove_incompatible(const SlamState& state, std::span<const SeenLandmark> seen,
                         std::vector<SlamPair>& pairs, std::vector<SlamState::Correction>& corrections) {
  int rows = 0;
  for (const SlamPair& p : pairs) rows += measured_rows(seen[p.sighting]);
  while (pairs.size() > 1 &&
         state.joint_squares(corrections) > chi_square_quantile(kJointGate, static_cast<double>(rows))) {
    std::size_t worst = 0;
    double lowest = kInfinite;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      std::vector<SlamState::Correction> rest = corrections;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(k));
      if (const double squares = state.joint_squares(rest); squares < lowest) lowest = squares, worst = k;
    }
    rows -= measured_rows(seen[pairs[worst].sighting]);
    pairs.erase(pairs.begin() + static_cast<std::ptrdiff_t>(worst));
    corrections.erase(corrections.begin() + static_cast<std::ptrdiff_t>(worst));
  }
}

}  // namespace waymark::localization
