// SPDX-License-Identifier: Apache-2.0
#include "geodb/sqlite/row_inserter.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "geodb/sqlite/sql_text.hpp"

namespace waymark::geodb::sqlite {
namespace {

constexpr std::size_t kMaxRows = 64;            // more by one statement are no faster
constexpr std::size_t kMaxParameters = 32'766;  // SQLite's limit

std::size_t rows_of_statement(std::size_t columns) {
  return std::clamp<std::size_t>((kMaxParameters - 1) / columns, 1, kMaxRows);
}

// The last parameter is the number of rows that are bound. Without FAIL, SQLite would copy every page before
// it changes it, to undo several rows.
std::string insert_sql(std::string_view table, std::span<const std::string> columns) {
  const std::vector<std::string_view> values(columns.size(), "?");
  const std::vector<std::string> rows(rows_of_statement(columns.size()),
                                      fmt::format("({})", fmt::join(values, ", ")));
  return fmt::format("INSERT OR FAIL INTO {} ({}) SELECT * FROM (VALUES {}) LIMIT ?", quote_identifier(table),
                     fmt::join(columns, ", "), fmt::join(rows, ", "));
}

}  // namespace

RowInserter::RowInserter(const Database& database, std::string_view table,
                         std::span<const std::string> columns)
    : columns_(columns.size()),
      max_rows_(rows_of_statement(columns.size())),
      insert_(database.prepare(insert_sql(table, columns))) {}

void RowInserter::end_row() {
  if (++row_ == max_rows_) flush();
}

void RowInserter::flush() {
  if (row_ == 0) return;
  insert_.bind(static_cast<int>(columns_ * max_rows_) + 1, static_cast<std::int64_t>(row_));
  insert_.run();
  row_ = 0;
}

}  // namespace waymark::geodb::sqlite
