// SPDX-License-Identifier: Apache-2.0
#include "geodb/sqlite/attribute_column.hpp"

#include <type_traits>

namespace waymark::geodb {

const char* sql_type(AttributeSpec::Kind kind) {
  switch (kind) {
    case AttributeSpec::Kind::real:
      return "DOUBLE";
    case AttributeSpec::Kind::integer:
      return "INTEGER";
    case AttributeSpec::Kind::text:
      return "TEXT";
  }
  return "";
}

void bind_attribute(sqlite::Statement& statement, int parameter, const AttributeValue& value) {
  std::visit(
      [&](const auto& v) {
        if constexpr (std::is_same_v<std::decay_t<decltype(v)>, std::monostate>)
          statement.bind(parameter, nullptr);
        else
          statement.bind(parameter, v);
      },
      value);
}

AttributeValue read_attribute(const sqlite::Statement& row, int column, AttributeSpec::Kind kind) {
  if (row.null(column)) return {};
  switch (kind) {
    case AttributeSpec::Kind::real:
      return row.real(column);
    case AttributeSpec::Kind::integer:
      return row.integer(column);
    case AttributeSpec::Kind::text:
      return std::string(row.text(column));
  }
  return {};
}

}  // namespace waymark::geodb
