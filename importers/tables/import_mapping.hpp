// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "importers/tables/table_landmarks.hpp"
namespace waymark::importers {

/// What a mapping file says of a table.
struct ImportMapping {
  std::string layer = {};  ///< of a file that holds several; empty: not stated
  TableImport table = {};
};

/// Reads a mapping file (docs/reference/import.md): which column holds what, for tables of other people.
/// Throws Error{input} with the JSON path for members that are unknown or of a wrong kind.
ImportMapping read_import_mapping(const std::string& file);

}  // namespace waymark::importers
