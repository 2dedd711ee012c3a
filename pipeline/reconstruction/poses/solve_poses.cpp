// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/poses/solve_poses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>

#include "pipeline/reconstruction/poses/thin_tracks.hpp"

namespace waymark::pipeline {
namespace {

struct SeedPair {
  const MatchedPair* pair = nullptr;
  std::size_t pose = 0;
  double score = 0;
};

// Many matches with wide angles start best; narrow pairs give depths that lead astray.
double seed_score(const PairGeometry& geometry) {
  constexpr double kDegree = std::numbers::pi / 180;
  const double angle =
      (geometry.kind == PairKind::forward ? geometry.angles[2] : geometry.angles[1]) / kDegree;
  const double kind = geometry.kind == PairKind::general ? 1 : 0.6;
  return kind * std::min(400.0, double(geometry.inliers.size())) * std::min(1.0, angle / 10);
}

std::vector<SeedPair> seed_pairs(const ImageMatches& matches, const std::vector<bool>& open) {
  std::vector<SeedPair> seeds;
  for (const MatchedPair& pair : matches.pairs) {
    if (pair.geometry.kind == PairKind::rotation || !open[pair.images.first] || !open[pair.images.second])
      continue;
    for (std::size_t pose = 0; pose < pair.geometry.poses.size(); ++pose)
      seeds.push_back({&pair, pose, seed_score(pair.geometry) * (pose == 0 ? 1 : 0.95)});
  }
  std::ranges::stable_sort(seeds, [](const SeedPair& a, const SeedPair& b) { return a.score > b.score; });
  return seeds;
}

// Takes seeds from different images first, so that one bad image does not spoil all.
std::vector<SeedPair> varied(const std::vector<SeedPair>& seeds, std::size_t count) {
  std::vector<SeedPair> chosen, rest;
  std::multiset<std::size_t> used;
  for (const SeedPair& seed : seeds) {
    const bool fresh = used.count(seed.pair->images.first) + used.count(seed.pair->images.second) < 2;
    if (chosen.size() < count && fresh) {
      chosen.push_back(seed);
      used.insert(seed.pair->images.first);
      used.insert(seed.pair->images.second);
    } else {
      rest.push_back(seed);
    }
  }
  for (std::size_t i = 0; i < rest.size() && chosen.size() < count; ++i) chosen.push_back(rest[i]);
  return chosen;
}

std::vector<TiePoint> select(const std::vector<TiePoint>& tracks, const std::vector<std::size_t>& indices) {
  std::vector<TiePoint> out;
  for (const std::size_t i : indices) out.push_back(tracks[i]);
  return out;
}

// Number of images reachable from each by pairs, among the open ones.
std::vector<std::size_t> group_sizes(const ImageMatches& matches, const std::vector<bool>& open) {
  std::vector<std::size_t> group(open.size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (group[i] != i) i = group[i] = group[group[i]];
    return i;
  };
  for (const MatchedPair& pair : matches.pairs)
    if (open[pair.images.first] && open[pair.images.second]) {
      const std::size_t a = root(pair.images.first), b = root(pair.images.second);
      group[std::max(a, b)] = std::min(a, b);
    }
  std::vector<std::size_t> sizes(open.size(), 0), out(open.size(), 0);
  for (std::size_t i = 0; i < open.size(); ++i) ++sizes[root(i)];
  for (std::size_t i = 0; i < open.size(); ++i) out[i] = sizes[root(i)];
  return out;
}

class PoseSolver {
 public:
  PoseSolver(std::span<const ImageToMatch> images, std::span<const ImageFeatures> features,
             const ImageMatches& matches, const PoseSettings& settings)
      : matches_(matches), settings_(settings) {
    for (const LensGuess& lens : matches.lenses)
      start_.lenses.push_back({.camera = lens.camera, .readout_time = lens.readout_time});
    for (const ImageToMatch& image : images)
      start_.images.push_back({.name = image.name, .lens = image.lens, .time = image.time});
    std::vector<VerifiedPair> verified;
    for (const MatchedPair& pair : matches.pairs) verified.push_back({pair.images, pair.geometry.inliers});
    tracks_ = build_tracks(features, verified).points;
    open_.assign(images.size(), true);
  }

  SolvedPoses run() {
    SolvedPoses out;
    while (std::optional<PoseGrowth> best = solve_component()) {
      const std::size_t component = out.components.size();
      for (std::size_t i = 0; i < open_.size(); ++i)
        if (best->scene().images[i].world_from_camera) open_[i] = false;
      out.components.push_back({best->scene(), best->posed()});
      for (AdjustedImage& image : out.components.back().scene.images)
        if (image.world_from_camera) image.component = component;
    }
    std::ranges::stable_sort(
        out.components, [](const SolvedComponent& a, const SolvedComponent& b) { return a.posed > b.posed; });
    explain(out);
    return out;
  }

 private:
  std::optional<PoseGrowth> solve_component() {
    Reconstruction start = start_;
    for (const TiePoint& track : select(tracks_, thin_tracks(tracks_, start_, settings_.growing_marks))) {
      TiePoint rest;
      for (const Mark& m : track.marks)
        if (open_[m.image]) rest.marks.push_back(m);
      if (rest.marks.size() >= 2) start.points.push_back(std::move(rest));
    }
    const std::vector<std::size_t> reachable = group_sizes(matches_, open_);
    std::optional<PoseGrowth> best;
    SeedPair start_of_best;
    for (const SeedPair& seed : varied(seed_pairs(matches_, open_), settings_.seeds)) {
      PoseGrowth growth(start, matches_.lenses, settings_.growth);
      if (!growth.seed(seed.pair->images, seed.pair->geometry.poses[seed.pose])) continue;
      growth.grow();
      if (settings_.progress) settings_.progress(growth.posed());
      const bool complete = growth.posed() >= reachable[seed.pair->images.first];
      const bool better = !best || growth.posed() > best->posed();
      if (better) best = std::move(growth), start_of_best = seed;
      if (complete) break;
    }
    if (best) replace_by_twin(*best, start_of_best, start);
    if (!best) return best;
    std::vector<TiePoint> all;
    for (TiePoint& track : select(tracks_, thin_tracks(tracks_, start_, settings_.final_marks))) {
      std::erase_if(track.marks,
                    [&](const Mark& m) { return !best->scene().images[m.image].world_from_camera; });
      if (track.marks.size() >= 2) all.push_back(std::move(track));
    }
    best->finish(std::move(all));
    return best;
  }

  // A plane seen along one line of motion has two solutions for all images at once: its normal and the motion
  // are exchanged. Relief alone distinguishes them, by residuals that differ little. All solutions of the
  // pair that a growth began with are grown, therefore, and that of lowest cost is taken.
  void replace_by_twin(PoseGrowth& best, const SeedPair& seed, const Reconstruction& start) const {
    const std::vector<RelativePose>& poses = seed.pair->geometry.poses;
    if (poses.size() < 2) return;
    std::optional<double> cost;
    for (std::size_t pose = 0; pose < poses.size(); ++pose) {
      if (pose == seed.pose) continue;
      PoseGrowth twin(start, matches_.lenses, settings_.growth);
      if (!twin.seed(seed.pair->images, poses[pose])) continue;
      twin.grow();
      if (twin.posed() < best.posed()) continue;
      if (!cost) cost = PoseGrowth(best).settled_cost(start.points);
      const double of_twin = PoseGrowth(twin).settled_cost(start.points);
      if (!(of_twin < *cost)) continue;
      best = std::move(twin);
      cost = of_twin;
    }
  }

  void explain(SolvedPoses& out) const {
    out.failures.assign(open_.size(), "");
    std::vector<std::size_t> matches(open_.size(), 0);
    for (const MatchedPair& pair : matches_.pairs)
      for (const std::size_t i : {pair.images.first, pair.images.second})
        matches[i] = std::max(matches[i], pair.geometry.inliers.size());
    for (std::size_t i = 0; i < open_.size(); ++i) {
      if (!open_[i]) continue;
      out.failures[i] =
          matches[i] == 0 ? "it matches no other image: check its overlap, sharpness and exposure"
                          : fmt::format(
                                "it shares at most {} points with another image, too few of them with known "
                                "positions: add images between it and the others",
                                matches[i]);
    }
  }

  const ImageMatches& matches_;
  const PoseSettings& settings_;
  Reconstruction start_;
  std::vector<TiePoint> tracks_;
  std::vector<bool> open_;  // images without a pose
};

}  // namespace

SolvedPoses solve_poses(std::span<const ImageToMatch> images, std::span<const ImageFeatures> features,
                        const ImageMatches& matches, const PoseSettings& settings) {
  return PoseSolver(images, features, matches, settings).run();
}

}  // namespace waymark::pipeline
