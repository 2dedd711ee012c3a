// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "geo/image_source.hpp"
#include "importers/images/image.hpp"
#include "pipeline/engine/codec.hpp"
namespace waymark::importers {

/// Makes images from their metadata, `columns` and `rows` included. Files are opened when first read; at most
/// RasterHandles::kIdle files of a set stay open. Reading throws if the file cannot be read.
ImageSet image_set(const std::vector<ImageInfo>& images, int band = 0);

/// Returns an ImageInfo as one line of JSON. Equal images give equal text.
std::string to_json(const ImageInfo& image);

std::string encode_images(const ImageSet& images);
ImageSet decode_images(std::string_view bytes);

}  // namespace waymark::importers

namespace waymark::pipeline {

/// Stores an image set as its recipe; decoding opens no file.
template <>
struct Codec<ImageSet> {
  static std::string encode(const ImageSet& images) { return importers::encode_images(images); }
  static ImageSet decode(std::string_view bytes) { return importers::decode_images(bytes); }
};

}  // namespace waymark::pipeline
