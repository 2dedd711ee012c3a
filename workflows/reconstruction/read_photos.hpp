// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
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
  std::optional<double> time = {};  ///< of exposure, s since an instant common to all pictures of a camera
  std::size_t lens = 0;             ///< index into `Photos::lenses`
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
  /// Camera file whose lens holds: of an image that it names, else of the same image size; empty: none.
  std::string lens = {};
  double readout_time = 0;  ///< s from the first row to the last, where `lens` states none; 0: global shutter
  std::size_t max_images = 400;  ///< images taken; more are thinned evenly in the order of their names
};

/// Lists pictures and reads their metadata. Files that are no pictures are passed over.
/// - The camera file may name other images, or none: what it says of these pictures is used, and what does
/// not
///   apply is stated in a summary or a warning.
/// - Times are those of EXIF, else of the camera file.
/// Throws Error{input} without two usable pictures.
Photos read_photos(const PhotosRequest& request, const Callbacks& callbacks = {});

/// Returns the means of blocks of `by` x `by` pixels; `read` gives the pixels of a window. Incomplete blocks
/// at the right and lower borders are left out.
Pixels block_means(const std::function<Pixels(const Window&)>& read, std::int64_t columns, std::int64_t rows,
                   std::int64_t by);

/// Returns the smallest whole number by which columns and rows are divided to have at most `max_pixels`.
int reduction_to(std::int64_t columns, std::int64_t rows, double max_pixels);

/// Reads the brightness of a picture reduced by a whole number: means of blocks. `max_pixels` bounds its
/// size.
struct ReducedPixels {
  Pixels pixels = {};
  int factor = 1;
};
ReducedPixels read_reduced(const Photo& photo, double max_pixels);

}  // namespace waymark::workflows
