// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include "geo/crs.hpp"
namespace waymark {

/// One row of a table, as text: what it means is for the caller to say.
struct TableRow {
  std::int64_t number = 0;         ///< line of a text file, from 1; else the feature's number
  std::vector<std::string> cells;  ///< one per column; empty: no value
};

/// What is known of a table before its rows are read.
struct TableHeader {
  std::string path;
  std::string layer;                 ///< of a file that holds several; the file's stem otherwise
  std::vector<std::string> columns;  ///< as the table names them; a table without a header has c1, c2, ...
  std::optional<Crs> crs;            ///< of its positions, where the table tells
  bool has_points = false;           ///< columns geom_x, geom_y, geom_z come from geometries
  bool decimal_comma = false;        ///< 3,5 means three and a half
  std::string row_word = "line";     ///< what TableRow::number counts
};

/// A table that is read row by row. One thread at a time.
class TableSource {
 public:
  virtual ~TableSource() = default;
  virtual const TableHeader& header() const = 0;
  /// False at the end. Throws Error{input} naming the row where it is broken; the next call goes on behind
  /// it.
  virtual bool next(TableRow& row) = 0;

  /// "craters.csv, line 17".
  std::string place_of(const TableRow& row) const;
};

enum class TableFormat { by_name, csv, ogr };

/// Text tables (csv: separated by comma, semicolon, tab, bar or blanks, with or without a header, quotes as
/// in RFC 4180, lines that begin with # are comments), and every vector layer GDAL reads (ogr), `/vsi...`
/// paths too. by_name: .csv, .tsv, .txt, .dat and .tab are text. `layer` chooses among several layers; empty:
/// the one called `type`, else the only one with geometries, else the only one. Lines without geometry and
/// area geometries are points too: a polygon gives its centroid and column geom_area. Throws Error{input}.
std::unique_ptr<TableSource> open_table(const std::string& path, TableFormat format, const std::string& layer,
                                        const std::string& type);

// Its two kinds.
std::unique_ptr<TableSource> open_csv_table(const std::string& path);
std::unique_ptr<TableSource> open_ogr_table(const std::string& path, const std::string& layer,
                                            const std::string& type);

}  // namespace waymark
