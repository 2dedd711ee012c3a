// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "geo/similarity.hpp"
#include "pipeline/reconstruction/adjustment/observations.hpp"
#include "pipeline/reconstruction/reconstruction.hpp"
namespace waymark::pipeline {

/// Start of a georeference.
struct StartFrame {
  std::optional<Similarity> map_from_frame = {};  ///< none: `messages` say what is missing
  std::vector<std::string> messages = {};
};

/// Finds the similarity from the frame of a component to the map: by control points and positions of cameras;
/// by two of these if the upward direction is known; for those on one line, by the DEM's heights, too.
StartFrame start_frame(const Reconstruction& scene, const Observations& observations, std::size_t component);

}  // namespace waymark::pipeline
