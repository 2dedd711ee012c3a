// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "geo/image_source.hpp"
#include "importers/images/image.hpp"
#include "pipeline/engine/codec.hpp"
namespace waymark {

/// Images by what is known of them, `columns` and `rows` included. Files are opened when first read; of all
/// files of a set at most RasterHandles::kIdle stay open. One whose file cannot be read throws when read.
ImageSet image_set(const std::vector<ImageInfo>& images, int band = 0);

/// All of an ImageInfo as one line of JSON: equal images give equal text.
std::string to_json(const ImageInfo& image);

/// An image set on disk is its recipe: decoding opens no file.
template <>
struct Codec<ImageSet> {
  static std::string encode(const ImageSet& images);
  static ImageSet decode(std::string_view bytes);
};

}  // namespace waymark
