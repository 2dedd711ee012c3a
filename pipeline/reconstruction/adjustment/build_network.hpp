// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <vector>
#include "pipeline/reconstruction/adjustment/adjust.hpp"
#include "pipeline/reconstruction/adjustment/network.hpp"
namespace waymark::pipeline {

/// Observations left out, by index.
struct LeftOut {
  std::vector<bool> control = {}, positions = {}, attitudes = {}, ups = {}, heights = {};
};

/// Network of a reconstruction, with the blocks of its parts.
struct BuiltNetwork {
  Network network = {};
  std::vector<std::shared_ptr<const LensModel>> models = {};  ///< by lens
  std::vector<std::optional<std::size_t>> lens_blocks = {}, pose_blocks = {}, point_blocks = {},
                                          control_blocks = {};
  std::optional<std::size_t> bias_block = {};
};

/// Builds the network of all posed images and positioned points. Images are taken in the order of their
/// names, points in that of their marks. Throws Error{input} as adjust() does. `scene` and `observations`
/// must outlive the network.
BuiltNetwork build_network(const Reconstruction& scene, const Observations& observations,
                           const AdjustmentOptions& options, const LeftOut& left_out);

/// Writes poses, lenses and points of the network into the reconstruction.
void write_back(const BuiltNetwork& built, Reconstruction& scene);

}  // namespace waymark::pipeline
