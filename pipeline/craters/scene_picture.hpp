// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/grid.hpp"
#include "core/random.hpp"
#include "pipeline/craters/shaded_scene.hpp"
namespace waymark::pipeline {

/// Returns the brightness of square relief (heights in pixels) under a sun towards -x at `elevation`
/// radians, with cast shadows. `sky` is diffuse light. `lommel` is the weight of Lommel-Seeliger against
/// Lambert shading for a view from above (lunar-Lambert law of McEwen 1991), [0, 1].
Pixels light_relief(const Grid<float>& heights, double elevation, double sky, double lommel = 0);

/// Applies the contrast stretch and the quantisation of published images.
void stretch_contrast(Pixels& image, Random& random);

/// Rotates a scene lit from -x by quarter turns, so that no image axis is special, and sets its sun angle.
void turn_quarters(LabelledScene& scene, int quarters);

}  // namespace waymark::pipeline
