// SPDX-License-Identifier: Apache-2.0
#include "pipeline/vision/half_image.hpp"

namespace waymark::pipeline {

Pixels half_image(const Pixels& image) {
  Pixels half(image.columns() / 2, image.rows() / 2);
  for (std::int64_t r = 0; r < half.rows(); ++r)
    for (std::int64_t c = 0; c < half.columns(); ++c)
      half(c, r) = 0.25f * (image(2 * c, 2 * r) + image(2 * c + 1, 2 * r) + image(2 * c, 2 * r + 1) +
                            image(2 * c + 1, 2 * r + 1));
  return half;
}

}  // namespace waymark::pipeline
