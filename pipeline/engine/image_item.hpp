// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>
#include "pipeline/engine/codec.hpp"
namespace waymark::pipeline {

/// One image of a job; an image-scope stage runs once per image.
struct ImageItem {
  std::int64_t index = 0;  ///< in the order of the list, from 0
  std::string name;        ///< unique
  std::string file;        ///< its bytes enter the fingerprint and the provenance; empty: none
  /// Everything else that determines its results, as text: pose, sun, georeference.
  /// Only `file` and `content` enter the fingerprint of its units, so another image leaves existing results
  /// valid.
  std::string content;

  friend bool operator==(const ImageItem&, const ImageItem&) = default;
};

/// Codec of the list of images of a job.
template <>
struct Codec<std::vector<ImageItem>> {
  static std::string encode(const std::vector<ImageItem>& images);
  static std::vector<ImageItem> decode(std::string_view bytes);
};

/// Returns "image_" and the name as a folder name: all but letters, digits, '.', '-' and '_' become %XX.
std::string unit_item(const ImageItem& image);

}  // namespace waymark::pipeline
