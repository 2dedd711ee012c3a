// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>
#include "core/landmark.hpp"
#include "geo/crs.hpp"
#include "importers/tables/table.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark {

/// How a table becomes landmarks.
struct TableImport {
  std::string type;            ///< landmark type; empty: the column `type`, or else the layer's name
  std::string columns;         ///< "x=lon,y=lat,radius=diam/2"; see bind_columns
  std::string table_crs;       ///< of the table's positions, replacing what the table says; empty: as it says
  std::string map_crs;         ///< of the map; empty: as the table
  bool skip_bad_rows = false;  ///< rows that cannot be read are rejected instead of an error
};

struct ImportedTable {
  Crs crs = Crs::local();             ///< of the landmarks
  std::vector<std::string> types;     ///< that were looked for
  std::vector<Landmark> landmarks;    ///< sorted by type and place, named
  std::vector<Observation> rejected;  ///< those of the rejected rows that have a position in the map
  std::int64_t rows = 0;              ///< = landmarks + rejected
  std::map<std::string, std::int64_t> rejected_by_reason;
  std::string first_rejection;        ///< where and why; empty: none
  std::vector<std::string> bindings;  ///< "radius = Diam_km*1000/2"; "depth" for a column of that name
  std::vector<std::string> warnings;
};

/// Reads all rows. A row is rejected, and counted, if it has no position, lies where the map's CRS has none,
/// has a feature outside its plausible range, a negative deviation or a confidence outside [0, 1]. A row of a
/// type not asked for is rejected too. Missing features are unknown. Deviations stand for a spread; counts
/// not given are 1. Throws Error: a cell that is no number or a broken row (naming its line), a uid used
/// twice, no CRS told, and a table none of whose rows is plausible (most likely its unit is another).
/// About 0.15 M rows/s; memory is that of the landmarks.
ImportedTable import_table(TableSource& table, const TypeRegistry& types, const TableImport& how);

}  // namespace waymark
