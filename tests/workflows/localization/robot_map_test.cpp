// SPDX-License-Identifier: Apache-2.0
#include "workflows/localization/robot_map.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/atomic_file.hpp"
#include "core/locked_folder.hpp"
#include "geo/point_at_height.hpp"
#include "geodb/write_map.hpp"
#include "workflows/mapping/import_landmarks.hpp"
#include "workflows/registries.hpp"

namespace waymark::test {
using namespace workflows;
namespace {

class ImportedMap : public ::testing::Test {
 protected:
  RobotMap of_table(const std::string& table, double min_confidence = 0) const {
    write_file(file("table.csv"), table);
    ImportRequest import{.table = file("table.csv"), .map = file("map.gpkg")};
    import.options.table_crs = "local";
    import_landmarks(import);
    return open_robot_map(file("map.gpkg"), nullptr, false, min_confidence).map;
  }
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

  LockedFolder folder_{std::filesystem::temp_directory_path()};
};

TEST_F(ImportedMap, ItsFrameLiesOnTheGroundOfTheLandmarks) {
  write_file(file("alps.csv"),
             "type,x,y,z\nrock,400000,5130000,2390\nrock,404000,5130000,2410\nrock,400000,5133000,2400\n");
  ImportRequest import{.table = file("alps.csv"), .map = file("alps.gpkg")};
  import.options.table_crs = "EPSG:32632";
  import_landmarks(import);
  const RobotMap map = open_robot_map(file("alps.gpkg"), nullptr).map;
  EXPECT_EQ(map.frame.origin().xyz.z(), 2400);
  for (const localization::MapLandmark& rock : all_landmarks(map, nullptr)) {
    const Eigen::Vector3d there = map.frame.crs_from_map_frame({{rock.at.x(), rock.at.y(), 0}}).xyz;
    EXPECT_LT((plan_position(map.frame, there.x(), there.y()) - rock.at).norm(), 0.01);
    EXPECT_NEAR(there.z(), 2400, 2);
  }
  EXPECT_EQ(of_table("type,x,y,z\nrock,0,0,50\nrock,9,0,70\n").frame.origin().xyz.z(), 0);  // a local CRS
}

TEST_F(ImportedMap, TheMiddleOfAGeographicMapIsThatOfItsLandmarks) {
  const auto origin = [&](const std::string& rows) {
    write_file(file("globe.csv"), "type,x,y\n" + rows);
    ImportRequest import{.table = file("globe.csv"), .map = file("globe.gpkg")};
    import.options.table_crs = "EPSG:4326";
    import_landmarks(import);
    const RobotMap map = open_robot_map(file("globe.gpkg"), nullptr).map;
    for (const localization::MapLandmark& rock : all_landmarks(map, nullptr))
      EXPECT_LT(rock.at.norm(), 200000);
    return Eigen::Vector2d(map.frame.origin().xyz.head<2>());
  };
  EXPECT_LT((origin("rock,8,46\nrock,9,46\nrock,8,47\nrock,9,47\n") - Eigen::Vector2d(8.5, 46.5)).norm(),
            0.01);
  const Eigen::Vector2d antimeridian = origin("rock,179.5,0\nrock,-179.5,0\nrock,179.9,1\nrock,-179.9,-1\n");
  EXPECT_NEAR(std::abs(antimeridian.x()), 180, 1e-9);
  EXPECT_NEAR(antimeridian.y(), 0, 1e-9);
  EXPECT_NEAR(origin("rock,0,89.5\nrock,90,89.5\nrock,180,89.5\nrock,-90,89.5\n").y(), 90, 1e-6);
}

class SurveyAccuracy : public ImportedMap {
 protected:
  double of_table(const std::string& table) const { return ImportedMap::of_table(table).survey_sd; }
};

class HeldTypes : public ImportedMap {
 protected:
  static std::vector<std::string> names(const RobotMap& map) {
    std::vector<std::string> all;
    for (const TypeId type : map.held_types) all.push_back(map.types()[type].name);
    return all;
  }
};

TEST_F(SurveyAccuracy, IsTheMedianOfAnImportedMap) {
  EXPECT_NEAR(of_table("type,x,y,position_sd\ntree,0,0,0.1\ntree,9,0,0.3\ntree,0,9,8\n"), 0.3, 1e-6);
}

// A wall is known across, not along.
TEST_F(SurveyAccuracy, IsThatAcrossAnElongatedEllipse) {
  EXPECT_NEAR(of_table("type,x,y,x_sd,y_sd\ntree,0,0,5,0.2\ntree,9,0,0.2,5\n"), 0.2, 1e-6);
}

TEST_F(SurveyAccuracy, IsZeroIfTheTableStatesNone) {
  EXPECT_EQ(of_table("type,x,y\ntree,0,0\ntree,9,0\n"), 0);
}

TEST_F(SurveyAccuracy, IsZeroOfAMapThatWasNotImported) {
  geodb::MapContents contents;
  contents.types = all_types();
  Landmark tree;
  tree.type = all_types().id("tree");
  tree.uid = "t";
  tree.covariance = Eigen::Matrix3d::Identity();
  tree.features.resize(all_types()[tree.type].features.size());
  tree.attributes.resize(all_types()[tree.type].attributes.size());
  tree.quality.feature_confidences.resize(tree.features.size());
  contents.landmarks = {tree};
  geodb::write_map(file("made.gpkg"), contents);
  EXPECT_EQ(open_robot_map(file("made.gpkg"), nullptr).map.survey_sd, 0);
}

TEST_F(HeldTypes, AreThoseOfTheLandmarksNotOfTheTables) {
  const RobotMap map = of_table("type,x,y,confidence\ntree,0,0,0.9\npole,9,0,0.4\n");
  EXPECT_TRUE(map.types().find("rock"));
  EXPECT_EQ(names(map), (std::vector<std::string>{"pole", "tree"}));
}

TEST_F(HeldTypes, AreThoseOfTheLandmarksThatAreRead) {
  EXPECT_EQ(names(of_table("type,x,y,confidence\ntree,0,0,0.9\npole,9,0,0.4\n", 0.5)),
            std::vector<std::string>{"tree"});
}

TEST(EmptyRobotMap, HoldsNoTypes) {
  EXPECT_TRUE(make_empty_robot_map().map.held_types.empty());
}

}  // namespace
}  // namespace waymark::test
