// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/image_source.hpp"
namespace waymark {

/// An image without holes, and where they were.
struct FilledImage {
  Pixels pixels;  ///< NaN replaced by the mean of what is known nearby, so that no edge appears
  Grid<std::int64_t>
      known_sum;         ///< summed-area table of known pixels, one row and column more than the image
  bool complete = true;  ///< there were no holes
  bool flat = true;      ///< no contrast at all, or nothing known

  /// Share of known pixels in the square of side `size` about a place; what lies outside the image is
  /// unknown.
  double known(double x, double y, double size) const;
};

FilledImage filled(const Pixels& image);

}  // namespace waymark
