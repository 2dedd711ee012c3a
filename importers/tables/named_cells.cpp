// SPDX-License-Identifier: Apache-2.0
#include "importers/tables/named_cells.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.hpp"
#include "core/lower_case.hpp"
#include "importers/tables/table_number.hpp"

namespace waymark::importers {

std::optional<std::size_t> NamedCells::find(std::initializer_list<std::string_view> names) const {
  for (const std::string_view name : names)
    for (std::size_t i = 0; i < header().columns.size(); ++i)
      if (lower_case(header().columns[i]) == name) return i;
  return {};
}

std::size_t NamedCells::need(const char* what, std::initializer_list<std::string_view> names,
                             const char* hint) const {
  if (const auto found = find(names)) return *found;
  throw Error(ErrorCode::input, fmt::format("the table has no column '{}'", what), header().path,
              fmt::format("{}; it has: {}", hint, fmt::join(header().columns, ", ")));
}

double NamedCells::number(std::size_t column, const char* hint) const {
  if (const auto value = to_real(text(column), header().decimal_comma)) return *value;
  throw Error(ErrorCode::input, fmt::format("'{}' is not a number", text(column)),
              fmt::format("{}, column {}", location(), header().columns[column]), hint);
}

double NamedCells::deviation(std::optional<std::size_t> column, double otherwise) const {
  if (!column || is_missing(text(*column))) return otherwise;
  const double sd = number(*column, "a standard deviation in metres");
  if (sd > 0) return sd;
  throw Error(ErrorCode::input, fmt::format("the standard deviation {} is not above 0", sd), location(),
              "leave the cell empty if it is unknown");
}

}  // namespace waymark::importers
