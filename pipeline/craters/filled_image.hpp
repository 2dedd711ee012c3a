// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/image_source.hpp"
namespace waymark::pipeline {

/// Image with its holes filled, and a table of the pixels that were known.
struct FilledImage {
  Pixels pixels;  ///< NaN replaced by the mean of known pixels nearby, so that no edge appears
  Grid<std::int64_t>
      known_sum;         ///< summed-area table of known pixels; one row and column larger than the image
  bool complete = true;  ///< there were no holes
  bool flat = true;      ///< no contrast at all, or nothing known

  /// Returns the fraction of known pixels in the square of side `size` centred at (x, y). Pixels outside
  /// the image count as unknown.
  double known_fraction(double x, double y, double size) const;
};

FilledImage fill_holes(const Pixels& image);

}  // namespace waymark::pipeline
