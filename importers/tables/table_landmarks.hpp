// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>
#include "core/landmark.hpp"
#include "geo/crs.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::importers {

class TableSource;

/// Options for importing a table as landmarks.
struct TableImport {
  std::string type;              ///< landmark type; empty: the column `type`, or else the layer's name
  std::string columns;           ///< "x=lon,y=lat,radius=diam/2"; see bind_columns
  std::string type_column = {};  ///< column that holds the type of a row; empty: `type`
  std::map<std::string, std::string> type_words = {};       ///< word of that column -> landmark type
  std::map<std::string, std::string> columns_of_type = {};  ///< landmark type -> more `columns`, for its rows
  std::string table_crs;  ///< of the table's positions, overriding the table's own; empty: the table's own
  std::string map_crs;    ///< of the map; empty: the table's
  std::string aoi = {};   ///< file of polygons: rows outside are rejected; empty: none are
  bool skip_bad_rows = false;  ///< reject rows that cannot be read instead of throwing
};

/// Reason of rows outside the area of interest.
inline constexpr const char* kOutsideArea = "outside the area of interest";

/// What was read of a table, and the rows that were rejected.
struct ImportedTable {
  Crs crs = Crs::local();             ///< of the landmarks
  std::vector<std::string> types;     ///< that were read
  std::int64_t landmarks = 0;         ///< number of landmarks
  std::vector<Observation> rejected;  ///< those of the rejected rows that have a position in the map
  std::int64_t rows = 0;              ///< = landmarks + rejected
  std::map<std::string, std::int64_t> rejected_by_reason;
  std::string first_rejection;        ///< location and reason; empty: none
  std::vector<std::string> bindings;  ///< "radius = Diam_km*1000/2"; "depth" for a column of that name
  std::vector<std::string> unused;    ///< columns of the table that nothing was taken from
  std::vector<std::string> warnings;
};

/// Reads all rows and passes the landmarks to `take`, in the order of rows. A landmark without a uid in the
/// table has none.
/// - A row is rejected, and counted, if it has no position, lies outside the domain of the map's CRS, or is
///   of another type. So is one with a feature outside its plausible range, a negative deviation or a
///   confidence outside [0, 1].
/// - Missing features and position deviations are unknown (NaN), a missing height is 0, missing counts are 1.
///   A deviation is taken as a spread.
/// Throws Error for a cell that is no number, a broken row, an unknown CRS, and a table without a plausible
/// row. About 0.15 M rows/s; memory is that of the rejected rows.
ImportedTable import_table(TableSource& table, const TypeRegistry& types, const TableImport& how,
                           const std::function<void(Landmark&&)>& take);

}  // namespace waymark::importers
