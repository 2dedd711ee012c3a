// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>
#include "geo/camera.hpp"
#include "pipeline/reconstruction/matching/build_tracks.hpp"
#include "pipeline/reconstruction/matching/choose_pairs.hpp"
#include "pipeline/reconstruction/matching/pair_geometry.hpp"
namespace waymark::pipeline {

/// Lens before the adjustment.
struct LensGuess {
  Camera camera = {};
  double focal_sd = 0.2;    ///< of the focal length, as a fraction of it
  double readout_time = 0;  ///< s from the first row to the last: a rolling shutter; 0: global

  /// Returns whether the focal length is good enough for essential matrices.
  bool is_calibrated() const { return focal_sd < 0.1; }
};

/// Image as the matching sees it.
struct ImageToMatch {
  std::string name = {};
  std::size_t lens = 0;                          ///< index into the lenses
  std::optional<Eigen::Vector3d> position = {};  ///< metres, to choose neighbours
  std::optional<double> time = {};               ///< s, since any instant common to all images
};

struct MatchedPair {
  ImagePair images;
  PairGeometry geometry;
};

struct ImageMatches {
  std::vector<MatchedPair> pairs = {};  ///< those whose geometry is known, sorted by images
  std::vector<LensGuess> lenses = {};   ///< with focal lengths voted by the pairs where they were unknown
  std::vector<bool> voted = {};         ///< by lens: whether the focal length is such a vote
  std::size_t tried = 0;                ///< pairs matched in full
};

struct ImageMatching {
  PairChoice choice = {};
  MatchSettings match = {};
  double pixels = 1.5;  ///< smallest threshold of agreement, pixels
  double of_diagonal =
      8e-4;                ///< threshold as a fraction of the image diagonal, for lenses not yet calibrated
  PairSettings pair = {};  ///< but threshold and seed, which follow from the images
  std::function<void(std::size_t done, std::size_t all)> progress = {};
};

/// Matches the features of images and estimates the geometry of each pair, in parallel over pairs.
/// - Where a focal length is unknown, fundamental matrices vote for it first.
/// - Matches that rest at their pixel while the others move show the vehicle and are dropped.
/// - The result depends neither on threads nor on the order in which pairs are done.
ImageMatches match_images(std::span<const ImageToMatch> images, std::span<const ImageFeatures> features,
                          std::span<const LensGuess> lenses, const ImageMatching& settings);

/// Returns the rays of features in the camera frame; zero where the lens cannot be inverted.
std::vector<Eigen::Vector3d> feature_rays(const Camera& camera, const ImageFeatures& features);

/// Returns matches without those that rest at one pixel while the median of the others moves by 10 px.
std::vector<Match> without_static(std::vector<Match> matches, const ImageFeatures& first,
                                  const ImageFeatures& second);

}  // namespace waymark::pipeline
