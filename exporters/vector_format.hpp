// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "geo/crs.hpp"
namespace waymark {

/// A vector format of this GDAL, as far as an export must know it.
struct VectorFormat {
  std::string driver;           ///< OGR's short name
  bool is_file = true;          ///< false: a database, written in place
  bool one_layer = false;       ///< a file holds the landmarks of one type only
  bool can_be_read = true;      ///< by this GDAL, as one file: what is written can be checked
  bool is_table = false;        ///< no geometry: positions become columns x, y, z in the CRS of the export
  bool earth_only = false;      ///< means longitude and latitude on WGS 84 by its definition
  bool only_wgs84 = false;      ///< and cannot say otherwise
  std::string place_name = {};  ///< field for the name of a place, where the format has one
  std::string place_description = {};  ///< and for what is said of it
  std::size_t longest_name = 0;        ///< letters of a column name; 0: no limit
};

/// The format called `driver` (any case), or the one `out`'s extension stands for where `driver` is empty.
/// Throws Error{usage} with the nearest name where this GDAL cannot write it.
VectorFormat vector_format(const std::string& out, const std::string& driver);

/// The CRS to write a map of `map_crs` in: what was asked for, else the map's, else EPSG:4326 where the
/// format means that. `what` names the map in messages. Throws Error{usage} where the format cannot hold it,
/// and PROJ's reason where it is on another body.
Crs output_crs(const VectorFormat& format, const Crs& map_crs, const std::string& asked,
               const std::string& what);

/// Column names as the format holds them: unchanged, or cut and kept unique, with a short ending (`_sd`,
/// `_low`) kept: prominence_low becomes promin_low where ten letters fit.
std::vector<std::string> fitting_names(const VectorFormat& format, const std::vector<std::string>& names);

}  // namespace waymark
