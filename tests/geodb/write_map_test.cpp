// SPDX-License-Identifier: Apache-2.0
#include "geodb/write_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/error.hpp"
#include "geodb/map_store.hpp"
#include "tests/geodb/map_scenes.hpp"

namespace waymark::test {
using namespace geodb;
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

LandmarkType plain_type(const std::string& name, const std::string& feature) {
  LandmarkType type;
  type.name = name;
  type.features.resize(1);
  type.features[0].name = feature;
  return type;
}

void expect_equal(const Landmark& a, const Landmark& b) {
  EXPECT_EQ(a.uid, b.uid);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_EQ(a.attributes, b.attributes);
  EXPECT_EQ(a.observations, b.observations);
  EXPECT_EQ(a.confidence, b.confidence);
  EXPECT_EQ(a.quality.seen, b.quality.seen);
  EXPECT_EQ(a.quality.visible, b.quality.visible);
  EXPECT_EQ(a.quality.feature_confidences, b.quality.feature_confidences);
  ASSERT_EQ(a.features.size(), b.features.size());
  for (std::size_t i = 0; i < a.features.size(); ++i) {
    EXPECT_EQ(a.features[i].known(), b.features[i].known());
    if (!a.features[i].known()) continue;
    EXPECT_EQ(a.features[i].value, b.features[i].value);
    EXPECT_NEAR(a.features[i].variance, b.features[i].variance, 1e-15);  // stored as its root
    EXPECT_EQ(a.features[i].observations, b.features[i].observations);
  }
}

TEST(WriteMap, ReadsBackAsWritten) {
  const TemporaryFolder folder;
  const MapContents contents = scattered({.landmarks = 500});
  write_map(folder / "map.gpkg", contents);
  const MapStore map = MapStore::open(folder / "map.gpkg");
  EXPECT_EQ(map.count(), 500);
  EXPECT_EQ(map.crs().id(), "EPSG:32632");
  EXPECT_THAT(map.types().names(), ElementsAre("lamp_post"));
  for (const Landmark& landmark : contents.landmarks) {
    const auto found = map.find(landmark.uid);
    ASSERT_TRUE(found) << landmark.uid;
    expect_equal(*found, landmark);
  }
}

TEST(WriteMap, StoresEvidenceImagesAndRun) {
  const TemporaryFolder folder;
  const MapContents contents = scattered({});
  write_map(folder / "map.gpkg", contents);
  const MapStore map = MapStore::open(folder / "map.gpkg");
  EXPECT_THAT(map.images(), ::testing::ElementsAreArray(contents.images));
  EXPECT_THAT(map.runs(), ElementsAre(contents.run));
  EXPECT_EQ(map.observations().size(), contents.observations.size());
  const auto evidence = map.observations_of("lp-7");
  ASSERT_EQ(evidence.size(), 1u);
  EXPECT_EQ(evidence[0].position, contents.observations[7].position);
  EXPECT_EQ(*evidence[0].pixel, *contents.observations[7].pixel);
  EXPECT_EQ(evidence[0].features[0].value, contents.observations[7].features[0].value);
  EXPECT_FALSE(evidence[0].features[1].known());
  EXPECT_EQ(map.observations().back().rejected, "height is implausible");
}

TEST(WriteMap, ReadsTypesItWasNotBuiltWith) {
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", scattered({}));
  const MapStore map = MapStore::open(folder / "map.gpkg");
  const LandmarkType wanted = lamp_post(), read = map.types()[0];
  EXPECT_EQ(read.summary, wanted.summary);
  EXPECT_EQ(read.colour, wanted.colour);
  EXPECT_EQ(read.drawn_as, wanted.drawn_as);
  EXPECT_EQ(read.label_feature, wanted.label_feature);
  EXPECT_EQ(read.evidence, wanted.evidence);
  EXPECT_EQ(read.body, wanted.body);
  EXPECT_EQ(read.identification_reach, wanted.identification_reach);
  EXPECT_EQ(read.identifies_itself, wanted.identifies_itself);
  ASSERT_EQ(read.features.size(), 2u);
  EXPECT_EQ(read.features[1].name, "diameter");
  EXPECT_EQ(read.features[1].max_value, 0.6);
  ASSERT_EQ(read.attributes.size(), 3u);
  EXPECT_EQ(read.attributes[1].kind, AttributeSpec::Kind::integer);
}

TEST(WriteMap, SameContentsGiveTheSameBytes) {
  const TemporaryFolder folder;
  MapContents contents = scattered({.landmarks = 3000});
  contents.dem_coverage = ramp_dem(contents.crs, 300, 200);
  write_map(folder / "a.gpkg", contents);
  std::shuffle(contents.landmarks.begin(), contents.landmarks.end(), std::mt19937(7));
  write_map(folder / "b.gpkg", contents);
  EXPECT_TRUE(file_bytes(folder / "a.gpkg") == file_bytes(folder / "b.gpkg"));
}

TEST(WriteMap, TypesWithoutLandmarksGetNoTableUnlessNamed) {
  const TemporaryFolder folder;
  MapContents contents = scattered({});
  contents.types.add(plain_type("bollard", "height"));
  contents.types.add(plain_type("bench", "length"));
  write_map(folder / "map.gpkg", contents, {.empty_tables = {"bench"}});
  EXPECT_THAT(MapStore::open(folder / "map.gpkg").types().names(), ElementsAre("lamp_post", "bench"));
}

TEST(WriteMap, AMapWithoutLandmarksIsAMap) {
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", scattered({.landmarks = 0}));
  const MapStore map = MapStore::open(folder / "map.gpkg");
  EXPECT_EQ(map.count("lamp_post"), 0);
  EXPECT_TRUE(map.query({}).empty());
}

std::string message_of_writing(const MapContents& contents, const WriteMapOptions& options = {}) {
  const TemporaryFolder folder;
  execute_sql((write_map(folder / "map.gpkg", scattered({.landmarks = 1})), folder / "map.gpkg"), "");
  const std::string before = file_bytes(folder / "map.gpkg");
  std::string message = "written";
  try {
    write_map(folder / "map.gpkg", contents, options);
  } catch (const Error& error) {
    message = error.what();
    EXPECT_TRUE(file_bytes(folder / "map.gpkg") == before) << "the old map is kept";
  }
  const auto files = std::distance(std::filesystem::directory_iterator(folder.path()), {});
  EXPECT_EQ(files, 1) << "nothing is left over";
  return message;
}

TEST(WriteMap, RefusesWhatIsNoMap) {
  MapContents contents = scattered({});
  contents.landmarks[3].uid = "lp-4";
  EXPECT_THAT(message_of_writing(contents), HasSubstr("two landmarks have the same uid\n  lamp_post lp-4"));
  contents.landmarks[3].uid = "";
  EXPECT_THAT(message_of_writing(contents), HasSubstr("a landmark has no uid"));
  contents = scattered({});
  contents.landmarks[3].position.xyz.x() = std::nan("");
  EXPECT_THAT(message_of_writing(contents), HasSubstr("position is not finite\n  landmark lp-3"));
  contents = scattered({});
  contents.observations[2].landmark_uid = "lost";
  EXPECT_THAT(message_of_writing(contents), HasSubstr("refers to a missing landmark"));
  contents = {};
  contents.types.add(plain_type("run", "length"));
  EXPECT_THAT(message_of_writing(contents), HasSubstr("cannot have a landmark type named 'run'"));
  contents = {};
  contents.types.add(plain_type("post", "seen"));
  EXPECT_THAT(message_of_writing(contents), HasSubstr("two columns named 'seen'"));
}

TEST(WriteMap, ReplacesOnlyWhereAllowed) {
  EXPECT_EQ(message_of_writing(scattered({})), "written");
  EXPECT_THAT(message_of_writing(scattered({}), {.replace = false}), HasSubstr("exists already"));
}

TEST(WriteMap, NamesTheFolderThatIsMissing) {
  try {
    write_map("/nowhere/at/all/map.gpkg", scattered({.landmarks = 1}));
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("its folder does not exist\n  /nowhere/at/all\n"));
    EXPECT_EQ(error.code(), ErrorCode::output);
  }
}

}  // namespace
}  // namespace waymark::test
