// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include "importers/tables/table.hpp"
namespace waymark::importers {

/// Rows of a table whose cells are found by the names of their columns, in any case.
class NamedCells {
 public:
  /// Opens a table as open_table() does. Throws Error{input}.
  explicit NamedCells(const std::string& path) : table_(open_table(path, TableFormat::by_name, "", "")) {}

  const TableHeader& header() const { return table_->header(); }
  bool next() { return table_->next(row_); }  ///< reads the next row; false at the end
  std::string location() const { return table_->row_location(row_); }
  std::int64_t row() const { return row_.number; }  ///< line of a text file, from 1

  /// Returns the first column with one of the names, given in lower case.
  std::optional<std::size_t> find(std::initializer_list<std::string_view> names) const;
  /// Returns the same, or throws Error{input} that names `what` and the columns there are.
  std::size_t need(const char* what, std::initializer_list<std::string_view> names, const char* hint) const;
  const std::string& text(std::size_t column) const { return row_.cells[column]; }
  /// Returns the number in a cell. Throws Error{input} with its row and column for other text.
  double number(std::size_t column, const char* hint) const;
  /// Returns a standard deviation; `otherwise` without a column or for an empty cell. Throws Error{input}
  /// unless it is above 0.
  double deviation(std::optional<std::size_t> column, double otherwise) const;

 private:
  std::unique_ptr<TableSource> table_;
  TableRow row_;
};

}  // namespace waymark::importers
