// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>
#include "geo/crs.hpp"
#include "pipeline/engine/codec.hpp"
namespace waymark::importers {

/// Named point, map CRS.
struct PlaceName {
  std::string name;
  double x = 0, y = 0;
};

/// Names for the landmarks of a map.
struct PlaceNames {
  std::vector<PlaceName> places;
  double max_distance = 0;  ///< metres between a place and the landmark that gets its name
};

/// Reads the names of a gazetteer: any layer of points that GDAL reads, or a text table with columns x and y,
/// or lon and lat. `layer` and `column` may be empty: the only layer, and the column name, label or toponym
/// in any case. Rows without a name or a position in `into` are left out. Throws Error{input} for a file
/// without such columns.
std::vector<PlaceName> read_place_names(const std::string& path, const std::string& layer,
                                        const std::string& column, const Crs& into);

std::string encode_place_names(const PlaceNames& names);
PlaceNames decode_place_names(std::string_view bytes);

}  // namespace waymark::importers

namespace waymark::pipeline {

template <>
struct Codec<importers::PlaceNames> {
  static std::string encode(const importers::PlaceNames& names) {
    return importers::encode_place_names(names);
  }
  static importers::PlaceNames decode(std::string_view bytes) { return importers::decode_place_names(bytes); }
};

}  // namespace waymark::pipeline
