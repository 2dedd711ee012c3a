// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include "geodb/sqlite/sqlite.hpp"
namespace waymark::geodb::sqlite {

/// Inserts rows into a table, up to 64 by one statement: a statement opens every index of the table, which
/// takes longer than the insertion of a row. If an insertion fails, some rows of its statement may be there.
class RowInserter {
 public:
  RowInserter(const Database& database, std::string_view table, std::span<const std::string> columns);

  /// Returns the statement for the next row; its columns are parameters after before_first(). Bytes must stay
  /// until the rows of the statement are inserted.
  Statement& statement() { return insert_; }
  int before_first() const { return static_cast<int>(row_ * columns_); }
  /// Returns the index of the next row among those of its statement, below max_rows().
  std::size_t row() const { return row_; }
  std::size_t max_rows() const { return max_rows_; }

  /// Ends a row whose columns are bound; inserts it now or with later ones.
  void end_row();
  /// Inserts the rows that wait.
  void flush();

 private:
  std::size_t columns_, max_rows_, row_ = 0;
  Statement insert_;
};

}  // namespace waymark::geodb::sqlite
