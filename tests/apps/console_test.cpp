// SPDX-License-Identifier: Apache-2.0
#include "apps/console.hpp"

#include <gmock/gmock.h>

#include <regex>
#include <sstream>

#include "tests/apps/made_dem.hpp"
#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class Console : public testing::Test {
 protected:
  std::string made(MadeDem dem) const {
    dem.compressed_blocks = true;
    return make_dem(folder_ / "dem.tif", dem);
  }

  TempFolder folder_;
};

// Without a terminal a bar has 80 columns.
TEST_F(Console, TheBarFitsIn80ColumnsWithAllItSays) {
  const std::string dem = made(hills(1300, 1300));
  const Outcome said = waymark(
      {"peaks", dem, "-o", folder_ / "m.gpkg", "--tile-cells", "64", "--threads", "1", "--progress", "bar"});
  ASSERT_EQ(said.code, 0) << said.err;
  const std::string bars = said.err.substr(0, said.err.rfind("\x1b[K"));
  const std::regex whole(
      R"([a-z_]+ +\[#*\.*\] +\d+ %(  [0-9.]+ units/s)?(  [-0-9]+(:[-0-9]{2})+ left)?(\x1b\[K)?\n?)");
  std::istringstream lines(bars);
  int with_all = 0;
  for (std::string line; std::getline(lines, line, '\r');) {
    if (line.empty()) continue;
    EXPECT_TRUE(std::regex_match(line, whole)) << line;
    EXPECT_LT(line.substr(0, line.find('\x1b')).size(), 80U) << line;
    with_all += line.find("units/s  ") != std::string::npos;
  }
  EXPECT_GT(with_all, 0) << bars;
}

TEST_F(Console, AnErrorBeginsOnALineOfItsOwn) {
  const std::string dem = made(hills(1300, 1300));
  damage(dem, 0.75);
  for (const char* progress : {"bar", "dots"}) {
    const Outcome said = waymark({"hazards", dem, "-o", folder_ / "h.tif", "--progress", progress});
    EXPECT_EQ(said.code, 1) << said.err;
    EXPECT_THAT(said.err, HasSubstr("hazards"));
    EXPECT_THAT(said.err, HasSubstr("\nerror: "));
    EXPECT_THAT(said.err, Not(HasSubstr("\n\nerror: ")));
  }
}

}  // namespace
}  // namespace waymark::test
