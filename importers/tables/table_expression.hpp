// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>
#include "importers/tables/table.hpp"
namespace waymark::importers {

/// Arithmetic on the columns of a table: `diam/2`, `sqrt(geom_area/pi)`, `"Diameter (km)"*500`.
///   sum = term (+|- term)...   term = power (*|/ power)...   power = [-] value [^ power]
///   value = number | pi | column | "any column" | function(sum[, sum]) | (sum)
/// Functions: sqrt abs exp log log10 sin cos tan (radians) deg rad (into that unit) min max. Columns are
/// matched by name, exactly or else in any case; `` ` `` quotes like ".
class TableExpression {
 public:
  /// Throws Error{usage} with the position of the fault; for an unknown column with the nearest name, or all
  /// of them.
  TableExpression(std::string_view text, const std::vector<std::string>& columns);
  ~TableExpression();
  TableExpression(TableExpression&&) noexcept;
  TableExpression& operator=(TableExpression&&) noexcept;

  const std::string& text() const { return text_; }
  /// Returns the value; NaN if a column has none or the result is not finite (1/0, sqrt(-1)). Throws
  /// Error{input} with row and column for a cell that is no number.
  double value(const TableRow& row, const TableSource& table) const;
  /// Returns the text of the cell. Throws Error{usage} if the expression is more than a column name.
  const std::string& word(const TableRow& row) const;
  bool is_column() const;
  /// Adds the indices of the columns that the expression uses.
  void add_columns(std::set<std::size_t>& used) const;

  struct Node;

 private:
  std::string text_;
  std::unique_ptr<const Node> root_;
};

/// Returns the index of a column by name, exactly or else in any case. Throws Error{usage} if there is none,
/// or several.
std::size_t column_index(const std::vector<std::string>& columns, std::string_view name);

}  // namespace waymark::importers
