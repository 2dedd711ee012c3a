// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "pipeline/reconstruction/matching/choose_pairs.hpp"
#include "pipeline/reconstruction/matching/match_features.hpp"
#include "pipeline/reconstruction/reconstruction.hpp"
namespace waymark::pipeline {

/// Matches of two images that agree with their geometry.
struct VerifiedPair {
  ImagePair images;
  std::vector<Match> matches = {};
};

struct Tracks {
  std::vector<TiePoint> points = {};  ///< without positions, each seen in two images or more
  std::size_t conflicts = 0;          ///< matches refused because they would join two places of one image
};

/// Joins matches to tracks by union-find.
/// - Features of an image at the same pixel are one place.
/// - Pairs with more matches come first. A match that would give a track two places in one image is refused,
///   which splits the track.
/// - The sd of a mark grows with the scale of its feature.
Tracks build_tracks(std::span<const ImageFeatures> images, std::span<const VerifiedPair> pairs);

/// Returns the standard deviation of the place of a SIFT feature, pixels.
double mark_sd(double scale);

}  // namespace waymark::pipeline
