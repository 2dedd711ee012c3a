// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "geo/crs.hpp"
#include "importers/gdal_session.hpp"
class OGRLayer;
namespace waymark {

/// Opens a vector file. Throws Error{input}: "there is no such <thing>" or what GDAL says, with `hint`.
GdalDataset open_vector(const std::string& path, const std::string& thing, const std::string& hint);

/// The layer of this name. Throws Error{usage} with the nearest of the names there are.
OGRLayer& layer_named(GDALDataset& dataset, const std::string& path, const std::string& name,
                      const std::vector<std::string>& all);

/// The layer's CRS; nothing where it has none or one nobody knows ("undefined Cartesian" and the like).
std::optional<Crs> crs_of(OGRLayer& layer);

}  // namespace waymark
