// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/canopy_source.hpp"
#include "pipeline/fusion/image_view.hpp"
namespace waymark {

/// A canopy model is an orthophoto of heights: evidence names its pixels.
ImageView canopy_view(const CanopySource& canopy);

}  // namespace waymark
