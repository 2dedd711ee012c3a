// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geodb/sqlite/sqlite.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::geodb {

/// Writes the landmark types to waymark_type, waymark_feature and waymark_attribute, so that programs can
/// read maps with types they were not built with.
void write_types(const sqlite::Database& database, const TypeRegistry& types);

/// Reads the landmark types. Throws Error if one is invalid.
TypeRegistry read_types(const sqlite::Database& database);

}  // namespace waymark::geodb
