// SPDX-License-Identifier: Apache-2.0
#include "geodb/sqlite/sqlite.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace waymark::test
