// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <vector>
#include "core/detection.hpp"
#include "geo/image_source.hpp"
#include "pipeline/engine/progress_meter.hpp"
namespace waymark::workflows {

/// Options of a search of an image of any size.
struct ImageSearch {
  double min_diameter = 8;       ///< pixels
  double max_diameter = 0;       ///< pixels; 0: 0.6 of the image's shorter side
  std::int64_t piece = 8192;     ///< longest side of a piece, pixels, >= 256
  bool reduce_for_large = true;  ///< false: objects larger than a sixteenth of a piece are not searched
  int threads = 0;               ///< 0: one per processor
  pipeline::ProgressMeter::Listener progress = {};  ///< counts finished pieces
};

/// Finds objects of one kind between two diameters, in pixels.
using ObjectDetector = std::function<std::vector<Detection>(const Pixels&, double min, double max)>;

/// Searches an image piece by piece, so that memory does not grow with it; one that fits is searched whole.
/// - Pieces overlap by the extent of the largest object and keep the objects in their own part.
/// - Objects larger than a sixteenth of a piece are found in the image reduced by a whole number.
/// - Of duplicates between pieces or scales the more certain is kept.
/// Returns the most certain first, ties by row, then column: the same for any number of threads.
std::vector<Detection> search_image(const ImageSource& image, const ImageSearch& search,
                                    const ObjectDetector& find);

/// Returns windows for estimates from part of an image: the whole, or the middle and four around it.
std::vector<Window> sample_windows(const ImageInfo& info, std::int64_t side);

/// Statistics of the brightness of all pixels.
struct Brightness {
  std::int64_t pixels = 0, no_data = 0, saturated = 0;
  float darkest = 0, brightest = 0;  ///< of pixels with data
};
/// Reads the image strip by strip.
Brightness measure_brightness(const ImageSource& image);

}  // namespace waymark::workflows
