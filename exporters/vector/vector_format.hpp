// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>
#include "geo/crs.hpp"
namespace waymark::exporters {

/// Properties of a vector format of this GDAL that matter for an export.
struct VectorFormat {
  std::string driver;           ///< OGR's short name
  bool is_file = true;          ///< false: a database, written in place
  bool one_layer = false;       ///< a file holds the landmarks of one type only
  bool can_be_read = true;      ///< by this GDAL, as one file: the output can be checked
  bool is_table = false;        ///< no geometry: positions become columns x, y, z in the CRS of the export
  bool earth_only = false;      ///< means longitude and latitude on WGS 84 by its definition
  bool only_wgs84 = false;      ///< and cannot hold another CRS
  std::string name_field = {};  ///< field for the name of a placemark; empty: none
  std::string description_field = {};   ///< field for its description
  std::int64_t bytes_per_landmark = 0;  ///< that GDAL holds until the file is closed
  std::int64_t max_landmarks = 0;       ///< in a layer; 0: no limit
  std::size_t max_name_length = 0;      ///< letters of a column name; 0: no limit
  bool has_false_origin = true;         ///< false: a CRS is stored without false easting and northing
  bool reports_writes = true;           ///< GDAL reports every write that fails
  bool has_index = true;                ///< false: FlatGeobuf's spatial index is left out
  std::vector<std::string> creation_options = {};  ///< of GDAL, "NAME=VALUE", besides the usual ones
};

/// Returns the format named `driver` (any case), or that of `out`'s extension if `driver` is empty. Throws
/// Error{usage} with the nearest name if this GDAL cannot write it.
VectorFormat vector_format(const std::string& out, const std::string& driver);

/// Chooses the CRS to write a map of `map_crs` in: `asked`, else the map's, else EPSG:4326 if the format
/// requires it; without its false easting and northing if the format cannot store them. `what` names the map
/// in messages. Throws Error{usage} if the format cannot hold it, and with
/// PROJ's reason if it is on another body.
Crs output_crs(const VectorFormat& format, const Crs& map_crs, const std::string& asked,
               const std::string& what);

/// Returns column names as the format holds them: unchanged, or shortened and unique, keeping a short ending
/// (`_sd`, `_low`). With ten letters prominence_low becomes promin_low.
std::vector<std::string> shorten_names(const VectorFormat& format, const std::vector<std::string>& names);

}  // namespace waymark::exporters
