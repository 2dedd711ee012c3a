// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>
#include "geodb/map_store.hpp"
#include "geodb/shape_layer.hpp"
namespace waymark::exporters {

/// Choice of the landmarks of a map.
struct LandmarkChoice {
  std::vector<std::string> types = {};                  ///< names
  std::function<bool(double x, double y)> inside = {};  ///< in the CRS of the map; empty: everywhere
  double min_confidence = 0;                            ///< 0: any, and unknown ones

  bool likely(const Landmark& landmark) const {
    return !(min_confidence > 0) || landmark.confidence >= min_confidence;
  }
  bool has(const geodb::MapStore& map, const Landmark& landmark) const;
};

/// Returns the shape layers of a map (crowns, stands, surveys, saddles) in another CRS. Rows are read from
/// the file when the layers are written.
/// - Rows of a layer with a column `uid` are kept where that landmark is chosen.
/// - Layers without one hold areas of the whole map: with `chosen.inside` they are left out.
/// - Rows without a position in the CRS are left out. `warnings` has what was left out.
std::vector<geodb::ShapeLayer> subset_layers(const geodb::MapStore& map, const LandmarkChoice& chosen,
                                             const Crs& crs, std::vector<std::string>& warnings);

}  // namespace waymark::exporters
