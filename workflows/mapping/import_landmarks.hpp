// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "importers/tables/table_landmarks.hpp"
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// A table of points that becomes a map.
struct ImportRequest {
  std::string table;                    ///< any path that GDAL opens; for mrclam also the dataset's folder
  std::string map;                      ///< to write; an older map of that name is replaced
  std::string format = {};              ///< "csv", "ogr" or "mrclam"; empty: by the name of the file
  std::string mapping = {};             ///< file that says what the columns are; the other members win
  std::string rules = {};               ///< file or name of rules for GIS layers, in place of columns
  std::string layer = {};               ///< of a file that holds several
  std::string unit = {};                ///< of local coordinates, for rules; empty: the file's, else metres
  importers::TableImport options = {};  ///< type, CRSs and columns
  std::string command_line = {};        ///< recorded in the map
};

/// Makes a map of a table's points, or of the elements of GIS layers by rules. Throws Error{usage} or
/// Error{output} for a map that cannot be written, Error{input} for a table that cannot be read. Messages:
/// how columns were interpreted, warnings, counts of rows and of rejected rows by reason. Returns the table
/// without its landmarks and rejected rows, which are in the map.
importers::ImportedTable import_landmarks(const ImportRequest& request, const Callbacks& callbacks = {});

/// Returns the names of the rules that come with the program.
std::vector<std::string> ready_rule_names();
/// Returns the text of a rules file, or of ready rules.
std::string rules_text(const std::string& file_or_name);

}  // namespace waymark::workflows
