// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "geodb/shape_layer.hpp"
#include "pipeline/forest/stand_inventory.hpp"
#include "pipeline/forest/stand_polygon.hpp"
namespace waymark::workflows {

/// A stand to be counted.
struct NamedStand {
  std::string name, species;
  pipeline::StandPolygon polygon;         ///< metres
  std::vector<geodb::ShapePart> outline;  ///< map CRS
};

/// Figures of a stand.
struct StandResult {
  NamedStand stand;
  pipeline::StandAttributes figures;  ///< of the detected trees, whatever recall is given
  pipeline::StandAttributes
      complete;  ///< corrected for undetected trees: by the given recall, else that of trees from the air
  pipeline::Estimate cover;  ///< fraction of the area under crowns, 0 to 1
};

}  // namespace waymark::workflows
