// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "geodb/shape_layer.hpp"
#include "pipeline/forest/stand_inventory.hpp"
#include "pipeline/forest/stand_polygon.hpp"
namespace waymark {

/// A stand to be counted.
struct NamedStand {
  std::string name, species;
  StandPolygon polygon;            ///< metres
  std::vector<ShapePart> outline;  ///< map CRS
};

/// Figures of a stand.
struct StandResult {
  NamedStand stand;
  StandAttributes figures;  ///< of the detected trees
  StandAttributes
      complete;    ///< corrected for undetected trees: by the given recall, else that of trees from the air
  Estimate cover;  ///< fraction of the area under crowns, 0 to 1
};

}  // namespace waymark
