// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include "pipeline/engine/codec.hpp"
#include "pipeline/reconstruction/matching/image_features.hpp"
#include "pipeline/reconstruction/matching/match_images.hpp"
#include "pipeline/reconstruction/poses/solve_poses.hpp"
#include "pipeline/reconstruction/reconstruction.hpp"
#include "pipeline/reconstruction/surface/sweep_chunk.hpp"
namespace waymark::pipeline {

// Results of the steps of a reconstruction as kept in a work folder.

template <>
struct Codec<ImageFeatures> {
  static std::string encode(const ImageFeatures& value);
  static ImageFeatures decode(std::string_view bytes);
};

template <>
struct Codec<ImageMatches> {
  static std::string encode(const ImageMatches& value);
  static ImageMatches decode(std::string_view bytes);
};

template <>
struct Codec<Reconstruction> {
  static std::string encode(const Reconstruction& value);
  static Reconstruction decode(std::string_view bytes);
};

template <>
struct Codec<SolvedPoses> {
  static std::string encode(const SolvedPoses& value);
  static SolvedPoses decode(std::string_view bytes);
};

template <>
struct Codec<ChunkHeights> {
  static std::string encode(const ChunkHeights& value);
  static ChunkHeights decode(std::string_view bytes);
};

}  // namespace waymark::pipeline
