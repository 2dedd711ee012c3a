// SPDX-License-Identifier: Apache-2.0
#include "geodb/map_editor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "core/error.hpp"
#include "geodb/validate_map.hpp"
#include "geodb/write_map.hpp"
#include "tests/geodb/map_scenes.hpp"
#include "tests/support/message_of.hpp"

namespace waymark::test {
using namespace geodb;
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Edited {
  explicit Edited(const Scene& scene) { write_map(path, scattered(scene)); }
  TemporaryFolder folder;
  std::filesystem::path path = folder / "map.gpkg";
};

TEST(MapEditor, InsertsUpdatesAndRemovesInPlace) {
  const Edited map({});
  {
    MapEditor editor = MapEditor::open(map.path);
    Landmark landmark = *editor.map().find("lp-3");
    landmark.position.xyz = {900'000, 5'000'000, 1};
    landmark.features[0].value = 19;
    editor.update(landmark);
    landmark.uid = "lp-new";
    editor.insert(landmark);
    editor.remove("lp-5");
  }
  const MapStore store = MapStore::open(map.path);
  EXPECT_EQ(store.count(), 1000);
  EXPECT_FALSE(store.find("lp-5"));
  EXPECT_EQ(store.find("lp-3")->features[0].value, 19);
  EXPECT_EQ(store.query({.box = MapQuery::Box{899'999, 4'999'999, 900'001, 5'000'001}}).size(), 2u);
  EXPECT_THAT(store.observations_of("lp-5"), IsEmpty());
  EXPECT_THAT(validate_map(map.path), IsEmpty());
}

TEST(MapEditor, AddsEvidenceImagesAndRuns) {
  const Edited map({});
  MapEditor editor = MapEditor::open(map.path);
  Observation seen = editor.map().observations_of("lp-1").at(0);
  seen.source = "image_2";
  editor.add_image({.name = "image_2",
                    .footprint = {},
                    .camera_json = "{}",
                    .taken_utc = {},
                    .sun_azimuth = {},
                    .sun_elevation = {},
                    .gsd = {}});
  editor.add_evidence(seen);
  editor.add_run(example_run());
  EXPECT_EQ(editor.map().observations_of("lp-1").size(), 2u);
  EXPECT_EQ(editor.map().find("lp-1")->observations, 5);
  EXPECT_EQ(editor.map().images().size(), 2u);
  EXPECT_EQ(editor.map().runs().size(), 2u);
  EXPECT_THAT(validate_map(map.path), IsEmpty());
}

TEST(MapEditor, ATransactionIsAllOrNothing) {
  const Edited map({});
  const std::string before = file_bytes(map.path);
  MapEditor editor = MapEditor::open(map.path);
  EXPECT_THROW(editor.transact([&] {
    editor.remove("lp-1");
    editor.remove("lp-2");
    editor.remove("not there");
  }),
               Error);
  EXPECT_EQ(editor.map().count(), 1000);
  EXPECT_TRUE(file_bytes(map.path) == before);
}

TEST(MapEditor, ManyRandomEditsLeaveThePackedIndexValid) {
  const Edited map({.landmarks = 2000});
  MapEditor editor = MapEditor::open(map.path);
  std::mt19937 random(5);
  editor.transact([&] {
    for (int i = 0; i < 1500; ++i) {
      const std::string uid = "lp-" + std::to_string(random() % 2000);
      auto landmark = editor.map().find(uid);
      if (!landmark) continue;
      landmark->position.xyz.x() += 1000;
      if (i % 3 == 0) {
        editor.remove(uid);
      } else if (i % 3 == 1) {
        editor.update(*landmark);
      } else {
        landmark->uid += "-copy" + std::to_string(i);
        editor.insert(*landmark);
      }
    }
  });
  EXPECT_THAT(validate_map(map.path), IsEmpty());
}

std::string message(const std::function<void()>& action) {
  return message_of([&] { action(); });
}

TEST(MapEditor, ReportsWhatItCannotDo) {
  const Edited map({});
  MapEditor editor = MapEditor::open(map.path);
  Landmark landmark = *editor.map().find("lp-1");
  EXPECT_THAT(message([&] { editor.insert(landmark); }), HasSubstr("has a landmark 'lp-1' already"));
  landmark.uid = "other";
  EXPECT_THAT(message([&] { editor.update(landmark); }), HasSubstr("has no landmark 'other'"));
  landmark.type = 9;
  EXPECT_THAT(message([&] { editor.insert(landmark); }), HasSubstr("no table for this type"));
}

}  // namespace
}  // namespace waymark::test
