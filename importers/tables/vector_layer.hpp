// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "geo/crs.hpp"
#include "importers/gdal_session.hpp"
class OGRLayer;
namespace waymark::importers {

/// Opens a vector file. Throws Error{input} with "there is no such <thing>" or GDAL's message, and `hint`.
GdalDataset open_vector(const std::string& path, const std::string& thing, const std::string& hint);

/// Returns the layer of this name. Throws Error{usage} with the nearest of the names in `all`.
OGRLayer& layer_named(GDALDataset& dataset, const std::string& path, const std::string& name,
                      const std::vector<std::string>& all);

/// Returns the layer's CRS; `std::nullopt` if it has none or an unknown one ("undefined Cartesian" and
/// similar).
std::optional<Crs> crs_of(OGRLayer& layer);

}  // namespace waymark::importers
