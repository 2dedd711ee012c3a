// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <vector>
#include "pipeline/reconstruction/adjustment/adjust.hpp"
#include "pipeline/reconstruction/adjustment/network.hpp"
#include "pipeline/reconstruction/adjustment/terms.hpp"
namespace waymark::pipeline {

/// Deviations of expected motions as factors of those stated, for the shifts and the turns of all images.
struct MotionScales {
  double shift = 1, turn = 1;
};

/// Observations left out, by index.
struct LeftOut {
  std::vector<bool> control = {}, positions = {}, attitudes = {}, ups = {}, heights = {},
                    heights_above_ground = {};
  std::vector<bool> motions = {};  ///< by image: expectations that are contradicted, and count for little
  MotionScales motion_scales = {};
};

/// Network of a reconstruction, with the blocks of its parts.
struct BuiltNetwork {
  Network network = {};
  std::vector<std::shared_ptr<const LensModel>> models = {};  ///< by lens
  std::vector<std::optional<std::size_t>> lens_blocks = {}, pose_blocks = {}, motion_blocks = {},
                                          point_blocks = {}, control_blocks = {};
  std::optional<std::size_t> bias_block = {};
};

/// Makes the term of a mark in a posed image of the network, with the motion of that image if it has one.
std::unique_ptr<Term> image_mark_term(const Observed& what, const Reconstruction& scene,
                                      const BuiltNetwork& built, const Mark& mark, std::size_t point);

/// Builds the network of all posed images and positioned points. Images are taken in the order of their
/// names, points in that of their marks. Throws Error{input} as adjust() does. `scene` and `observations`
/// must outlive the network.
BuiltNetwork build_network(const Reconstruction& scene, const Observations& observations,
                           const AdjustmentOptions& options, const LeftOut& left_out);

/// Writes poses, lenses and points of the network into the reconstruction.
void write_back(const BuiltNetwork& built, Reconstruction& scene);

}  // namespace waymark::pipeline
