// SPDX-License-Identifier: Apache-2.0
#include "workflows/localization/export_robot_map.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/locked_folder.hpp"
#include "core/text_file.hpp"
#include "workflows/localization/robot_map.hpp"
#include "workflows/mapping/import_landmarks.hpp"

namespace waymark::test {
using namespace workflows;
namespace {

using testing::HasSubstr;

/// Three rocks and a crater in UTM; positions in the frame of localization are those of the robot's map.
class RobotExport : public ::testing::Test {
 protected:
  void SetUp() override {
    write_file(file("table.csv"),
               "type,uid,x,y,z,radius\nrock,r1,500000,5200000,10,0.5\nrock,r2,500100.25,5200000,11,0.7\n"
               "rock,r3,500000,5199950.5,9,1\ncrater,c1,500020,5200010,8,12\n");
    ImportRequest import{.table = file("table.csv"), .map = file("map.gpkg")};
    import.options.table_crs = "EPSG:32632";
    import_landmarks(import);
  }
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string written(RobotFormat format, std::vector<std::string> types = {}) const {
    export_robot_map({.map = file("map.gpkg"),
                      .output = file("out"),
                      .format = format,
                      .types = std::move(types),
                      .overwrite = true});
    return read_text(file("out"), "the output");
  }
  std::map<std::string, Eigen::Vector3d> expected() const {
    const RobotMap map = open_robot_map(file("map.gpkg"), nullptr).map;
    std::map<std::string, Eigen::Vector3d> all;
    for (const Landmark& one : map.store->query({}))
      all[one.uid] = map.frame.map_frame_from_crs(one.position).xyz;
    return all;
  }

  LockedFolder folder_{std::filesystem::temp_directory_path()};
};

TEST_F(RobotExport, BelugaGetsACategoryForEachType) {
  const std::string text = written(RobotFormat::beluga);
  std::map<std::string, Eigen::Vector3d> found;
  std::map<std::string, int> categories;
  const std::regex line(R"(  - \{category: (\d+), position: \[(\S+), (\S+), (\S+)\]\}  # (\S+))");
  for (std::sregex_iterator i(text.begin(), text.end(), line), end; i != end; ++i) {
    found[(*i)[5]] = {std::stod((*i)[2]), std::stod((*i)[3]), std::stod((*i)[4])};
    categories[(*i)[5]] = std::stoi((*i)[1]);
  }
  const auto wanted = expected();
  ASSERT_EQ(found.size(), wanted.size());
  for (const auto& [uid, at] : wanted) EXPECT_TRUE(found.at(uid).isApprox(at, 1e-4)) << uid;
  EXPECT_EQ(categories["r1"], categories["r3"]);
  EXPECT_NE(categories["r1"], categories["c1"]);
  EXPECT_THAT(text, HasSubstr("  rock: " + std::to_string(categories["r1"]) + "\n"));
  EXPECT_THAT(text, HasSubstr("EPSG:32632"));
  // The boundaries hold all landmarks and touch the outermost.
  std::smatch box;
  ASSERT_TRUE(std::regex_search(text, box, std::regex(R"(min: \[(\S+), (\S+), \S+\], max: \[(\S+),)")));
  EXPECT_NEAR(std::stod(box[1]), std::min(wanted.at("r1").x(), wanted.at("r3").x()), 1e-4);
  EXPECT_NEAR(std::stod(box[2]), wanted.at("r3").y(), 1e-4);
  EXPECT_NEAR(std::stod(box[3]), wanted.at("r2").x(), 1e-4);
}

TEST_F(RobotExport, MrptGetsASectionOfBeacons) {
  std::map<std::string, std::map<std::string, std::string>> sections;
  std::istringstream lines(written(RobotFormat::mrpt, {"rock"}));
  std::string section;
  for (std::string text; std::getline(lines, text);) {
    if (text.empty() || text[0] == '#') continue;
    if (text[0] == '[')
      section = text.substr(1, text.size() - 2);
    else
      sections[section][text.substr(0, text.find(" = "))] = text.substr(text.find(" = ") + 3);
  }
  EXPECT_EQ(sections["MetricMap"]["landmarksMap_count"], "1");
  auto& beacons = sections["MetricMap_landmarksMap_00_creationOpts"];
  ASSERT_EQ(beacons["nBeacons"], "3");
  std::set<std::string> ids;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const char* number : {"001", "002", "003"}) {
    const std::string name = std::string("beacon_") + number;
    ids.insert(beacons.at(name + "_ID"));
    sum += Eigen::Vector3d(std::stod(beacons.at(name + "_x")), std::stod(beacons.at(name + "_y")),
                           std::stod(beacons.at(name + "_z")));
  }
  EXPECT_EQ(ids.size(), 3u);
  const auto wanted = expected();
  EXPECT_TRUE(sum.isApprox(wanted.at("r1") + wanted.at("r2") + wanted.at("r3"), 1e-3));
}

TEST_F(RobotExport, MrptWarnsOfMapsThatItsGridCannotHold) {
  const auto warnings = [&](RobotFormat format, double side) {
    write_file(file("wide.csv"), fmt::format("type,uid,x,y,z\nrock,a,0,0,0\nrock,b,{0},{0},0\n", side));
    ImportRequest import{.table = file("wide.csv"), .map = file("wide.gpkg")};
    import.options.table_crs = "local";
    import_landmarks(import);
    return export_robot_map(
               {.map = file("wide.gpkg"), .output = file("o"), .format = format, .overwrite = true})
        .warnings;
  };
  EXPECT_THAT(warnings(RobotFormat::mrpt, 1200), testing::IsEmpty());
  EXPECT_THAT(
      warnings(RobotFormat::mrpt, 4000),
      testing::ElementsAre(HasSubstr("4e+03 x 4e+03 m apart: MRPT's grid of 0.2 m cells over them will "
                                     "take 9.6 GB")));
  EXPECT_THAT(warnings(RobotFormat::beluga, 4000), testing::IsEmpty());
}

TEST_F(RobotExport, ProblemsAreNamed) {
  const auto error = [&](const RobotMapExport& request) {
    try {
      export_robot_map(request);
    } catch (const Error& problem) {
      return std::string(problem.what());
    }
    return std::string();
  };
  EXPECT_THAT(error({.map = file("map.gpkg"), .output = file("table.csv")}),
              HasSubstr("table.csv exists already"));
  EXPECT_THAT(error({.map = file("map.gpkg"), .output = file("o"), .types = {"rokc"}}), HasSubstr("rock"));
  EXPECT_THAT(error({.map = file("map.gpkg"), .output = file("o"), .types = {"crater"}, .min_confidence = 2}),
              HasSubstr("no landmarks of these types and this confidence"));
  EXPECT_EQ(parse_robot_format("Beluga"), RobotFormat::beluga);
  EXPECT_EQ(parse_robot_format("mrpt"), RobotFormat::mrpt);
  EXPECT_EQ(parse_robot_format("GPKG"), std::nullopt);
}

}  // namespace
}  // namespace waymark::test
