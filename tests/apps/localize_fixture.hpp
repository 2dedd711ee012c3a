// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gmock/gmock.h>

#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "made_drive.hpp"
#include "program.hpp"

namespace waymark::test {

/// A map of made rocks, and logs of drives among them.
class Localize : public testing::Test {
 protected:
  void SetUp() override { import_rocks(rocks_csv(), "local"); }

  void import_rocks(const std::string& csv, const std::string& crs) {
    write_text(folder_.path() / "rocks.csv", csv);
    std::filesystem::remove(map_);
    const Outcome said =
        waymark({"import", folder_ / "rocks.csv", "-o", map_, "--type", "rock", "--map-crs", crs});
    ASSERT_EQ(said.code, 0) << said.err;
  }
  /// Localizes by a log; the track is read and every number of it must be finite.
  Outcome localize(const std::string& log, std::vector<std::string> words = {}) {
    write_text(folder_.path() / "log.jsonl", log);
    std::filesystem::remove(track_);
    words.insert(words.begin(), {"localize", map_, folder_ / "log.jsonl", "-o", track_});
    const Outcome said = waymark(words);
    if (said.code == 0)
      expect_finite();
    else
      EXPECT_FALSE(std::filesystem::exists(track_)) << "half-written";
    return said;
  }
  void expect_finite() {
    std::istringstream rows(text_of(track_));
    std::string row;
    std::getline(rows, row);
    EXPECT_THAT(row,
                testing::StartsWith("t,x,y,z,roll,pitch,yaw,var_x,var_y,cov_xy,var_yaw,matched,rejected"));
    const bool names_crs = row.ends_with(",crs");
    for (rows_ = 0; std::getline(rows, row); ++rows_) {
      if (names_crs) row.resize(row.rfind(','));
      ASSERT_THAT(row, testing::AllOf(testing::Not(testing::HasSubstr("nan")),
                                      testing::Not(testing::HasSubstr("inf"))))
          << row;
      std::istringstream cells(row);
      for (std::string cell; std::getline(cells, cell, ',');)
        ASSERT_TRUE(cell.empty() || std::isfinite(std::stod(cell))) << row;  // empty: wrong matches not known
    }
  }
  nlohmann::json score(const std::string& truth, std::vector<std::string> more = {}) {
    std::vector<std::string> words{"evaluate", "track", track_, "--truth", truth, "--format", "json"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome said = waymark(words);
    EXPECT_EQ(said.code, 0) << said.err;
    return nlohmann::json::parse(said.out);
  }
  /// The last row of the track, by the names of its columns.
  std::map<std::string, double> last_row() {
    std::istringstream rows(text_of(track_));
    std::string names, row, last;
    std::getline(rows, names);
    while (std::getline(rows, row)) last = row;
    std::istringstream columns(names), cells(last);
    std::map<std::string, double> values;
    for (std::string name, cell; std::getline(columns, name, ',') && std::getline(cells, cell, ',');)
      if (!cell.empty()) values[name] = std::stod(cell);
    return values;
  }
  nlohmann::json score() { return score(folder_ / "log.jsonl"); }
  /// The message of a log or option that is refused.
  std::string refusal(const std::string& log, int code = 1, const std::vector<std::string>& words = {}) {
    const Outcome said = localize(log, words);
    EXPECT_EQ(said.code, code) << said.err;
    EXPECT_THAT(said.err, testing::StartsWith("error: "));
    return said.err;
  }

  TempFolder folder_;
  std::string map_ = folder_ / "map.gpkg", track_ = folder_ / "track.csv";
  int rows_ = 0;
};

}  // namespace waymark::test
