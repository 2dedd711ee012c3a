// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>
#include "core/landmark.hpp"
#include "pipeline/engine/codec.hpp"
namespace waymark::pipeline {

/// Landmarks between stages, all members, bit by bit.
template <>
struct Codec<std::vector<Landmark>> {
  static std::string encode(const std::vector<Landmark>& landmarks);
  static std::vector<Landmark> decode(std::string_view bytes);
};

}  // namespace waymark::pipeline
