// SPDX-License-Identifier: Apache-2.0
#include "geodb/sqlite/sqlite.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "core/locked_folder.hpp"
#include "geodb/sqlite/row_inserter.hpp"

namespace waymark::test {
using namespace geodb;
using namespace geodb::sqlite;
namespace {

template <class Text>
concept Bindable = requires(Statement& statement, Text&& text) {
  statement.bind(1, std::forward<Text>(text));
};

// SQLite reads the bytes when the statement runs, not when they are bound.
TEST(Sqlite, ATemporaryTextCannotBeBound) {
  EXPECT_TRUE(Bindable<std::string&>);
  EXPECT_TRUE(Bindable<const std::string&>);
  EXPECT_TRUE(Bindable<std::string_view>);
  EXPECT_TRUE(Bindable<const char*>);
  EXPECT_FALSE(Bindable<std::string>) << "a temporary does not outlive the statement's execution";
}

// The twin inserts row by row.
TEST(RowInserter, InsertsWhatSingleInsertionsDo) {
  const LockedFolder folder(std::filesystem::temp_directory_path());
  const Database database(folder.path() / "rows.sqlite", OpenMode::create);
  const std::vector<std::string> columns{"id", "name", "size"};
  for (const int rows : {0, 1, 63, 64, 65, 200}) {
    for (const char* table : {"many", "single"})
      database.execute(std::string("DROP TABLE IF EXISTS ") + table + "; CREATE TABLE " + table +
                       " (id INTEGER PRIMARY KEY, name TEXT, size DOUBLE); CREATE INDEX largest_" + table +
                       " ON " + table + " (size DESC) WHERE size >= 50");
    RowInserter many(database, "many", columns);
    Statement single = database.prepare("INSERT INTO single VALUES (?, ?, ?)");
    std::vector<std::string> names(many.max_rows());
    for (int i = 0; i < rows; ++i) {
      const std::string& name = names[many.row()] = "rock-" + std::to_string(i * 37 % 101);
      const double size = i % 5 == 0 ? std::nan("") : i * 7 % 100 + 0.5;  // NaN becomes NULL
      Statement& row = many.statement();
      row.bind(many.before_first() + 1, i + 1);
      row.bind(many.before_first() + 2, name);
      row.bind(many.before_first() + 3, size);
      many.end_row();
      single.bind_all(i + 1, name, size);
      single.run();
    }
    many.flush();
    many.flush();  // nothing waits
    EXPECT_EQ(database.integer("SELECT count(*) FROM many"), rows);
    EXPECT_EQ(database.integer("SELECT count(*) FROM (SELECT * FROM many EXCEPT SELECT * FROM single)"), 0);
    EXPECT_EQ(database.integer("SELECT count(*) FROM many INDEXED BY largest_many WHERE size >= 50"),
              database.integer("SELECT count(*) FROM single NOT INDEXED WHERE size >= 50"));
  }
}

}  // namespace
}  // namespace waymark::test
