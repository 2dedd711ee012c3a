// SPDX-License-Identifier: Apache-2.0
// Text tables longer than what is read at once.
#include <gmock/gmock.h>

#include <fstream>
#include <string>
#include <vector>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/locked_folder.hpp"
#include "core/random.hpp"
#include "importers/tables/table.hpp"

namespace waymark::test {
using namespace importers;
namespace {

struct MadeTable {
  std::string text;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::int64_t> lines;  ///< of the rows
};

/// Rows of three cells, some quoted with separators, quotes and line ends inside, comments and empty lines.
MadeTable made_table(std::uint64_t seed, std::size_t size, bool named) {
  MadeTable made;
  Random random(seed);
  std::int64_t line = 1;
  const auto add = [&](std::string_view text) {
    made.text += text;
    line += std::ranges::count(text, '\n');
  };
  add("\xEF\xBB\xBF# made, with a \" quote\n");
  if (named) add("a,b,c\n");
  while (made.text.size() < size) {
    if (random.bernoulli(0.05)) add(random.bernoulli(0.5) ? "# \"comment,\n" : " \r\n");
    made.lines.push_back(line);
    made.rows.emplace_back();
    for (int i = 0; i < 3; ++i) {
      std::string cell = std::to_string(random.uniform_index(1'000'000'000));
      std::string written = cell;
      if (named && random.bernoulli(0.2)) {
        cell += random.bernoulli(0.001) ? std::string(3'000'000, 'x') : "\n\"quoted\", and more";
        written.clear();
        for (const char c : cell) written += c == '"' ? "\"\"" : std::string(1, c);
        written = '"' + written + '"';
      }
      made.rows.back().push_back(cell);
      add(written + (i < 2 ? "," : random.bernoulli(0.5) ? "\r\n" : "\n"));
    }
  }
  return made;
}

class CsvTable : public testing::Test {
 protected:
  std::unique_ptr<TableSource> open(const std::string& text, const std::string& name = "t.csv") {
    write_file(folder_.path() / name, text);
    return open_table((folder_.path() / name).string(), TableFormat::csv, "", "");
  }

  LockedFolder folder_{std::filesystem::temp_directory_path()};
};

TEST_F(CsvTable, HasTheRowsThatWereWrittenWhereverPiecesEnd) {
  for (const bool named : {true, false})
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const MadeTable made = made_table(seed, 3'500'000, named);
      const auto table = open(made.text);
      EXPECT_EQ(table->header().columns, named ? std::vector<std::string>({"a", "b", "c"})
                                               : std::vector<std::string>({"c1", "c2", "c3"}));
      TableRow row;
      std::size_t n = 0;
      for (; table->next(row); ++n) {
        ASSERT_LT(n, made.rows.size());
        ASSERT_EQ(row.number, made.lines[n]) << "row " << n;
        ASSERT_TRUE(row.cells == made.rows[n]) << "row " << n;
      }
      EXPECT_EQ(n, made.rows.size());
    }
}

TEST_F(CsvTable, MayBeginWithMegabytesOfComments) {
  std::string comments;
  while (comments.size() < 2'500'000) comments += "# a, \"comment\n";
  const auto table = open(comments + "x;y\n1,5;2\n");
  EXPECT_EQ(table->header().columns, (std::vector<std::string>{"x", "y"}));
  TableRow row;
  ASSERT_TRUE(table->next(row));
  EXPECT_EQ(row.cells, (std::vector<std::string>{"1,5", "2"}));
  EXPECT_FALSE(table->next(row));
}

TEST_F(CsvTable, NamesFaultsInLaterPieces) {
  const std::string rows = made_table(7, 1'500'000, true).text;
  const auto fault = [&](const std::string& text) -> std::string {
    try {
      const auto table = open(text);
      for (TableRow row; table->next(row);) {
      }
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(fault(rows), "");
  EXPECT_THAT(fault(rows + "1,\"2,3\n" + std::string(3'000'000, '\n')),
              testing::HasSubstr("a quote is opened and never closed"));
  EXPECT_THAT(fault(rows + std::string("1,\0,3\n", 6)), testing::HasSubstr("it holds zero bytes"));
  EXPECT_THAT(fault(rows + "1,2\n"), testing::HasSubstr("the row has 2 values, the table has 3 columns"));
}

}  // namespace
}  // namespace waymark::test
