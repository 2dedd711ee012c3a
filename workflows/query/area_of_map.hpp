// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include "geodb/map_query.hpp"
namespace waymark::workflows {

/// Area of interest in the CRS of a map.
struct MapArea {
  std::function<bool(double x, double y)> contains;
  std::optional<geodb::MapQuery::Box> box;  ///< around it; absent across the antimeridian
};

/// Reads the polygons of a file. Throws Error{input} as importers::read_area_of_interest().
MapArea area_of_map(const std::string& aoi, const std::filesystem::path& map);

}  // namespace waymark::workflows
