// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/image_source.hpp"
namespace waymark::pipeline {

/// Halves an image by the means of 2 x 2 pixels; NaN where one of them is. An odd last row or column is
/// dropped.
Pixels half_image(const Pixels& image);

}  // namespace waymark::pipeline
