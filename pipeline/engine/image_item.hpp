// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>
#include "pipeline/engine/codec.hpp"
namespace waymark {

/// One image of a job; an image-scope stage runs once per image.
struct ImageItem {
  std::int64_t index = 0;  ///< in the order of the list, from 0
  std::string name;        ///< unique
  std::string file;        ///< its bytes enter the fingerprint and the provenance; empty: none
  /// All else that makes its results what they are, as text: pose, sun, georeference. With `file` it alone
  /// enters the fingerprint of the image's units, so one more image leaves the others' results as they are.
  std::string content;

  friend bool operator==(const ImageItem&, const ImageItem&) = default;
};

template <>
struct Codec<std::vector<ImageItem>> {
  static std::string encode(const std::vector<ImageItem>& images);
  static std::vector<ImageItem> decode(std::string_view bytes);
};

/// "image_" and the name, where all but letters, digits, '.', '-' and '_' are %XX: a folder's name.
std::string unit_item(const ImageItem& image);

}  // namespace waymark
