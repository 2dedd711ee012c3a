// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/matching/match_images.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/random.hpp"
#include "pipeline/reconstruction/matching/focal_vote.hpp"

namespace waymark::pipeline {
namespace {

double threshold_of(const Camera& camera, const ImageMatching& settings) {
  return std::max(settings.pixels,
                  settings.of_diagonal * std::hypot(double(camera.columns), double(camera.rows)));
}

std::uint64_t pair_seed(const ImageToMatch& a, const ImageToMatch& b) {
  return named_seed(named_seed(1, a.name), b.name);
}

std::vector<Eigen::Vector2d> centred_pixels(const Camera& camera, const ImageFeatures& features) {
  std::vector<Eigen::Vector2d> out;
  for (const Feature& f : features.features)
    out.emplace_back(f.pixel.x() - camera.cx, f.pixel.y() - camera.cy);
  return out;
}

// Votes for the focal length of each lens that is not calibrated, and drops matches off the fundamental
// matrix.
void vote_for_lenses(std::span<const ImageToMatch> images, std::span<const ImageFeatures> features,
                     const std::vector<ImagePair>& pairs, const ImageMatching& settings,
                     std::vector<std::vector<Match>>& matches, ImageMatches& out) {
  std::vector<std::optional<FocalEvidence>> evidence(pairs.size());
  tbb::parallel_for(std::size_t{0}, pairs.size(), [&](std::size_t p) {
    const auto [i, j] = pairs[p];
    const LensGuess &a = out.lenses[images[i].lens], &b = out.lenses[images[j].lens];
    if (a.is_calibrated() && b.is_calibrated()) return;
    const double threshold = std::max(threshold_of(a.camera, settings), threshold_of(b.camera, settings));
    FundamentalGeometry geometry = fundamental_geometry(matches[p], centred_pixels(a.camera, features[i]),
                                                        centred_pixels(b.camera, features[j]), threshold,
                                                        pair_seed(images[i], images[j]));
    if (images[i].lens == images[j].lens && !geometry.planar &&
        geometry.inliers.size() >= 2 * settings.pair.min_inliers)
      evidence[p] = {geometry.matrix, double(geometry.inliers.size())};
    if (geometry.inliers.size() >= settings.pair.min_inliers) matches[p] = std::move(geometry.inliers);
  });
  for (std::size_t lens = 0; lens < out.lenses.size(); ++lens) {
    if (out.lenses[lens].is_calibrated()) continue;
    std::vector<FocalEvidence> votes;
    for (std::size_t p = 0; p < pairs.size(); ++p)
      if (evidence[p] && images[pairs[p].first].lens == lens) votes.push_back(*evidence[p]);
    Camera& camera = out.lenses[lens].camera;
    const double width = double(std::max(camera.columns, camera.rows));
    if (const auto focal = vote_focal_length(votes, 0.3 * width, 5 * width)) {
      camera.fx = camera.fy = *focal;
      out.lenses[lens].focal_sd = 0.05;
      out.voted[lens] = true;
    }
  }
}

}  // namespace

std::vector<Eigen::Vector3d> feature_rays(const Camera& camera, const ImageFeatures& features) {
  std::vector<Eigen::Vector3d> rays;
  rays.reserve(features.features.size());
  for (const Feature& f : features.features) {
    const auto along = ray(camera, f.pixel);
    rays.push_back(along ? along->unit.normalized() : Eigen::Vector3d(0, 0, 0));
  }
  return rays;
}

std::vector<Match> without_static(std::vector<Match> matches, const ImageFeatures& first,
                                  const ImageFeatures& second) {
  constexpr double kRests = 1.5, kMoves = 10;
  const auto motion = [&](const Match& m) {
    return (first.features[m.first].pixel - second.features[m.second].pixel).norm();
  };
  std::vector<double> moving;
  for (const Match& m : matches)
    if (motion(m) > kRests) moving.push_back(motion(m));
  if (moving.size() < 10 || moving.size() == matches.size()) return matches;
  const auto middle = moving.begin() + static_cast<std::ptrdiff_t>(moving.size() / 2);
  std::nth_element(moving.begin(), middle, moving.end());
  if (*middle > kMoves) std::erase_if(matches, [&](const Match& m) { return motion(m) <= kRests; });
  return matches;
}

ImageMatches match_images(std::span<const ImageToMatch> images, std::span<const ImageFeatures> features,
                          std::span<const LensGuess> lenses, const ImageMatching& settings) {
  ImageMatches out;
  out.lenses.assign(lenses.begin(), lenses.end());
  out.voted.assign(lenses.size(), false);
  std::vector<std::optional<Eigen::Vector3d>> positions;
  for (const ImageToMatch& image : images) positions.push_back(image.position);
  const std::vector<ImagePair> pairs = choose_pairs(features, positions, settings.choice);
  out.tried = pairs.size();
  std::vector<std::vector<Match>> matches(pairs.size());
  std::atomic<std::size_t> done = 0;
  tbb::parallel_for(std::size_t{0}, pairs.size(), [&](std::size_t p) {
    const auto [i, j] = pairs[p];
    matches[p] =
        without_static(match_features(features[i], features[j], settings.match), features[i], features[j]);
    if (settings.progress) settings.progress(++done, pairs.size());
  });
  vote_for_lenses(images, features, pairs, settings, matches, out);
  std::vector<std::vector<Eigen::Vector3d>> rays(images.size());
  tbb::parallel_for(std::size_t{0}, images.size(), [&](std::size_t i) {
    rays[i] = feature_rays(out.lenses[images[i].lens].camera, features[i]);
  });
  std::vector<PairGeometry> geometries(pairs.size());
  tbb::parallel_for(std::size_t{0}, pairs.size(), [&](std::size_t p) {
    const auto [i, j] = pairs[p];
    const Camera &a = out.lenses[images[i].lens].camera, &b = out.lenses[images[j].lens].camera;
    PairSettings pair = settings.pair;
    pair.threshold = std::max(threshold_of(a, settings) / a.fx, threshold_of(b, settings) / b.fx);
    pair.seed = pair_seed(images[i], images[j]);
    geometries[p] = pair_geometry(matches[p], rays[i], rays[j], pair);
  });
  for (std::size_t p = 0; p < pairs.size(); ++p)
    if (geometries[p].kind != PairKind::none) out.pairs.push_back({pairs[p], std::move(geometries[p])});
  return out;
}

}  // namespace waymark::pipeline
