// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>
#include "geo/image_source.hpp"
#include "importers/images/photo_metadata.hpp"
#include "pipeline/reconstruction/matching/match_images.hpp"
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// Picture of a folder with what it says about its camera.
struct Photo {
  std::string name = {}, path = {};
  importers::PhotoMetadata metadata = {};
  double saturated = 0;  ///< brightness of saturated pixels; 0: unknown
  std::string taken_utc = {};
  std::size_t lens = 0;  ///< index into `Photos::lenses`
};

struct UnusedPhoto {
  std::string name = {}, reason = {};
};

struct Photos {
  std::vector<Photo> photos = {};                ///< sorted by name
  std::vector<pipeline::LensGuess> lenses = {};  ///< images of one size and camera share a lens
  std::vector<UnusedPhoto> unused = {};          ///< damaged files, orthophotos
};

struct PhotosRequest {
  std::vector<std::string> images = {};  ///< files, patterns or folders
  std::string lens = {};                 ///< camera file whose lens of the same image size holds; empty: none
  std::size_t max_images = 400;  ///< images taken; more are thinned evenly in the order of their names
};

/// Lists pictures and reads their metadata. Files that are no pictures are passed over.
/// Throws Error{input} without two usable pictures.
Photos read_photos(const PhotosRequest& request, const Callbacks& callbacks = {});

/// Reads the brightness of a picture reduced by a whole number: means of blocks. `max_pixels` bounds its
/// size.
struct ReducedPixels {
  Pixels pixels = {};
  int factor = 1;
};
ReducedPixels read_reduced(const Photo& photo, double max_pixels);

}  // namespace waymark::workflows
