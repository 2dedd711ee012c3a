// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/canopy_source.hpp"
#include "pipeline/fusion/projection/image_view.hpp"
namespace waymark::pipeline {

/// Returns the view of a canopy model, treated as an orthophoto of heights whose pixels evidence refers to.
ImageView canopy_view(const CanopySource& canopy);

}  // namespace waymark::pipeline
