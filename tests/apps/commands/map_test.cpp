// SPDX-License-Identifier: Apache-2.0
// Maps made from a drive with known poses.
#include <gtest/gtest.h>

#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

// 45 minutes in an office, by an odometry that turns left by 0.06 rad per metre: map of the even minutes,
// judged in the odd ones. A quarter of the drive leads through rooms without a map, which look like others
// that have one.
TEST(RealHall, IntelLabByItsOwnCornersAndEnds) {
  const auto data = std::filesystem::path(WAYMARK_SOURCE_DIR) / "../shared/data/environments/indoor_intel";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << data << " is not on this machine";
  TempFolder folder;
  const std::string split = WAYMARK_SOURCE_DIR "/tests/apps/split_minutes.py";
  ASSERT_EQ(std::system(
                ("python3 '" + split + "' '" + data.string() + "' '" + folder.path().string() + "'").c_str()),
            0);
  const std::string map = folder / "office.gpkg", log = folder / "intel.clf", track = folder / "track.csv";
  const Outcome made = waymark({"map", log, "--poses", folder / "even.csv", "-o", map});
  ASSERT_EQ(made.code, 0) << made.err;
  for (const std::string method : {"ekf", "pf"}) {
    const Outcome localized = waymark({"localize", map, log, "-o", track, "--method", method, "--ids",
                                       "unknown", "--start", "0.6003,-0.032,-0.35467"});
    ASSERT_EQ(localized.code, 0) << localized.err;
    const Outcome said =
        waymark({"evaluate", "track", track, "--truth", folder / "odd.csv", "--format", "json"});
    ASSERT_EQ(said.code, 0) << said.err;
    const auto score = nlohmann::json::parse(said.out);
    std::cout << method << ": median " << score["ate_median"] << " m, RMS " << score["ate_rmse"] << " m\n";
    EXPECT_LT(score["ate_median"], 0.08) << method;
    EXPECT_LT(score["ate_rmse"], 0.25) << method;
  }
}

}  // namespace
}  // namespace waymark::test
