// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include "geo/crs.hpp"
namespace waymark::importers {

/// One row of a table, as text.
struct TableRow {
  std::int64_t number = 0;         ///< line of a text file, from 1; else the feature's number
  std::vector<std::string> cells;  ///< one per column; empty: no value
};

/// Properties of a table, known before its rows are read.
struct TableHeader {
  std::string path;
  std::string layer;                 ///< name of the layer, or the file's stem if it has no layers
  std::vector<std::string> columns;  ///< names in the table; c1, c2, ... for a table without a header
  std::optional<Crs> crs;            ///< of its positions, if the table names it
  bool has_points = false;           ///< columns geom_x, geom_y, geom_z come from geometries
  bool decimal_comma = false;        ///< 3,5 means 3.5
  std::string row_word = "line";     ///< the unit that TableRow::number counts
};

/// A table that is read row by row. One thread at a time may use it.
class TableSource {
 public:
  virtual ~TableSource() = default;
  virtual const TableHeader& header() const = 0;
  /// Reads the next row; returns false at the end. Throws Error{input} with the row if it is broken; the next
  /// call continues after it.
  virtual bool next(TableRow& row) = 0;

  /// Returns the location of a row for messages: "craters.csv, line 17".
  std::string row_location(const TableRow& row) const;
};

enum class TableFormat { by_name, csv, ogr };

/// Opens a table, `/vsi...` paths included.
/// - csv: text separated by comma, semicolon, tab, bar or blanks, with or without a header. Quotes are those
///   of RFC 4180; lines that begin with # are comments.
/// - ogr: every vector layer GDAL reads. `layer` chooses among several layers; empty: the one named `type`,
///   else the only one with geometries, else the only one.
/// - by_name: .csv, .tsv, .txt, .dat and .tab are text, other files ogr.
/// - Lines become points; a polygon gives its centroid and column geom_area.
/// Throws Error{input}.
std::unique_ptr<TableSource> open_table(const std::string& path, TableFormat format, const std::string& layer,
                                        const std::string& type);

// Opens a table of one format.
std::unique_ptr<TableSource> open_csv_table(const std::string& path);
std::unique_ptr<TableSource> open_ogr_table(const std::string& path, const std::string& layer,
                                            const std::string& type);

}  // namespace waymark::importers
