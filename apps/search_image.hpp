// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <vector>
#include "core/detection.hpp"
#include "geo/image_source.hpp"
#include "pipeline/engine/progress_meter.hpp"
namespace waymark {

/// How an image of any size is searched.
struct ImageSearch {
  double min_diameter = 8;                ///< pixels
  double max_diameter = 0;                ///< pixels; 0: 0.6 of the image's shorter side
  std::int64_t piece = 8192;              ///< longest side of what is searched at once, pixels, >= 256
  bool reduce_for_large = true;           ///< false: nothing larger than a sixteenth of a piece is looked for
  int threads = 0;                        ///< 0: one per processor
  ProgressMeter::Listener progress = {};  ///< is told how many of the pieces are done
};

/// Finds things of one kind in some pixels: between two diameters, in pixels.
using FindThings = std::function<std::vector<Detection>(const Pixels&, double min, double max)>;

/// Searches an image piece by piece, so that memory does not grow with it; one that fits is searched whole.
/// Pieces overlap by what the largest thing looked for needs, and keep what lies in their own part. Things
/// larger than a sixteenth of a piece are looked for in the image reduced by a whole number. What two pieces
/// or two scales found twice is kept once, the more certain. The most certain first, ties by row, then
/// column: the same for any number of threads.
std::vector<Detection> search_image(const ImageSource& image, const ImageSearch& search,
                                    const FindThings& find);

/// Pieces of the image for estimates that need not see all of it: the whole, or the middle and four around.
std::vector<Window> sample_windows(const ImageInfo& info, std::int64_t side);

/// What can be said of the brightness of all pixels, read strip by strip.
struct Brightness {
  std::int64_t pixels = 0, no_data = 0, saturated = 0;
  float darkest = 0, brightest = 0;  ///< of pixels with data
};
Brightness brightness_of(const ImageSource& image);

}  // namespace waymark
