// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>
#include "pipeline/engine/codec.hpp"
#include "pipeline/fusion/projection/image_view.hpp"
namespace waymark::pipeline {

// Image views between stages, all members, bit by bit.

template <>
struct Codec<ImageView> {
  static std::string encode(const ImageView& image);
  static ImageView decode(std::string_view bytes);
};
template <>
struct Codec<std::vector<ImageView>> {
  static std::string encode(const std::vector<ImageView>& images);
  static std::vector<ImageView> decode(std::string_view bytes);
};

}  // namespace waymark::pipeline
