// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "pipeline/reconstruction/adjustment/build_network.hpp"
#include "pipeline/reconstruction/adjustment/image_order.hpp"
namespace waymark::pipeline {

/// Adds the common error of all heights that have one, as an unknown, if there are such heights.
void add_height_bias(const Reconstruction& scene, const Observations& seen, BuiltNetwork& built);

/// Adds what is observed of cameras beside their marks, to a network that has their poses and the tie points:
/// positions, attitudes, upward directions and heights, in the order of the images, then what is known of
/// lenses. Exact components of a position are held. Throws Error{input} for a lens or a parameter that there
/// is not.
void add_observed_cameras(const Reconstruction& scene, const Observations& seen, const ImageOrder& order,
                          const LeftOut& left_out, BuiltNetwork& built);

/// Returns the index of a parameter of a lens. Throws Error{input} with those that it has.
int lens_parameter(const LensModel& model, std::size_t lens, const std::string& name);

}  // namespace waymark::pipeline
