// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "importers/tables/table_landmarks.hpp"
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// A table of points that becomes a map.
struct ImportRequest {
  std::string table;                    ///< any path that GDAL opens; for mrclam also the dataset's folder
  std::string map;                      ///< to write; an older map of that name is replaced
  std::string format = {};              ///< "csv", "ogr" or "mrclam"; empty: by the name of the file
  std::string mapping = {};             ///< file that says what the columns are; the other members win
  std::string layer = {};               ///< of a file that holds several
  importers::TableImport options = {};  ///< type, CRSs and columns
  std::string command_line = {};        ///< recorded in the map
};

/// Makes a map of a table's points. Throws Error{usage} or Error{output} for a map that cannot be written,
/// Error{input} for a table that cannot be read.
/// Messages: how columns were interpreted, warnings, counts of rows and of rejected rows by reason.
/// Returns the table without its landmarks and rejected rows, which are in the map.
importers::ImportedTable import_landmarks(const ImportRequest& request, const Callbacks& callbacks = {});

}  // namespace waymark::workflows
