// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "pipeline/reconstruction/adjustment/build_network.hpp"
#include "pipeline/reconstruction/adjustment/image_order.hpp"
namespace waymark::pipeline {

/// Adds the motions of the images to a network that has their poses: unknowns with the expectation of their
/// neighbours in time as an observation, or held if `estimate` is false or nothing is expected.
void add_motions(const Reconstruction& scene, const ImageOrder& order, const LeftOut& left_out, bool estimate,
                 BuiltNetwork& built);

}  // namespace waymark::pipeline
