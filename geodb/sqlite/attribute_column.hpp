// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/attribute.hpp"
#include "geodb/sqlite/sqlite.hpp"
namespace waymark::geodb {

/// Returns the SQL type of a column of attributes.
const char* sql_type(AttributeSpec::Kind kind);

/// Binds an attribute to a parameter; unknown values are NULL.
void bind_attribute(sqlite::Statement& statement, int parameter, const AttributeValue& value);
AttributeValue read_attribute(const sqlite::Statement& row, int column, AttributeSpec::Kind kind);

}  // namespace waymark::geodb
