// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>
#include "core/detection.hpp"
#include "core/landmark.hpp"
#include "core/observation.hpp"
#include "pipeline/engine/codec.hpp"
namespace waymark::pipeline {

// Detections and observations between stages, all members, bit by bit.

/// Codec of detections in an image.
template <>
struct Codec<std::vector<Detection>> {
  static std::string encode(const std::vector<Detection>& detections);
  static std::vector<Detection> decode(std::string_view bytes);
};
/// Codec of observations.
template <>
struct Codec<std::vector<Observation>> {
  static std::string encode(const std::vector<Observation>& observations);
  static std::vector<Observation> decode(std::string_view bytes);
};

/// Landmarks between stages, all members, bit by bit.
template <>
struct Codec<std::vector<Landmark>> {
  static std::string encode(const std::vector<Landmark>& landmarks);
  static std::vector<Landmark> decode(std::string_view bytes);
};

}  // namespace waymark::pipeline
