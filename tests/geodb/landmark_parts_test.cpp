// SPDX-License-Identifier: Apache-2.0
// A map of landmarks in parts does not depend on the parts, nor on the number of landmarks in memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <algorithm>
#include <map>
#include <set>

#include "geodb/hilbert_ranges.hpp"
#include "geodb/map_store.hpp"
#include "geodb/validate_map.hpp"
#include "geodb/write_map.hpp"
#include "tests/geodb/map_scenes.hpp"

namespace waymark::test {
using namespace geodb;
namespace {

/// Landmarks divided into `columns` x `columns` squares; records how many are in memory at most.
class Parts {
 public:
  Parts(const MapContents& whole, int columns) : columns_(columns) {
    landmarks_.resize(static_cast<std::size_t>(columns * columns));
    evidence_.resize(landmarks_.size());
    std::map<std::string, std::size_t> part_of;
    for (const Landmark& l : whole.landmarks) {
      const std::size_t part = square(l.position.xyz);
      part_of[l.uid] = part;
      landmarks_[part].push_back(l);
    }
    for (const Observation& o : whole.observations)
      if (o.rejected.empty()) evidence_[part_of.at(o.landmark_uid)].push_back(o);
  }
  LandmarkParts parts() {
    return {.count = landmarks_.size(),
            .landmarks = [this](std::size_t part) { return lent(landmarks_[part]); },
            .evidence = [this](std::size_t part) { return lent(evidence_[part]); }};
  }
  std::size_t most() const { return most_; }

 private:
  std::size_t square(const Eigen::Vector3d& at) const {
    const auto cell = [&](double v, double low) { return static_cast<int>((v - low) / 1e5 * columns_); };
    return static_cast<std::size_t>(cell(at.x(), 4e5) * columns_ + cell(at.y(), 5e6));
  }
  template <class T>
  std::shared_ptr<const std::vector<T>> lent(const std::vector<T>& items) {
    lent_ += items.size();
    most_ = std::max(most_, lent_);
    return {new std::vector<T>(items), [this](const std::vector<T>* gone) {
              lent_ -= gone->size();
              delete gone;
            }};
  }
  int columns_;
  std::vector<std::vector<Landmark>> landmarks_;
  std::vector<std::vector<Observation>> evidence_;
  std::size_t lent_ = 0, most_ = 0;
};

MapContents held(int landmarks) {
  MapContents contents = scattered({.landmarks = landmarks, .with_evidence = landmarks});
  std::erase_if(contents.observations, [](const Observation& o) { return !o.rejected.empty(); });
  return contents;
}

MapContents without_landmarks(MapContents contents) {
  contents.landmarks.clear();
  contents.observations.clear();
  return contents;
}

// Rejected observations do not belong to landmarks: they may be in any part.
TEST(LandmarkParts, WriteRejectedObservationsInOneOrder) {
  const TemporaryFolder folder;
  const MapContents whole = held(300);
  std::vector<Observation> rejected(whole.observations.begin(), whole.observations.begin() + 200);
  for (std::size_t i = 0; i < rejected.size(); ++i) {
    rejected[i].landmark_uid.clear();
    rejected[i].rejected = i % 2 == 0 ? "seen twice in one image" : "outside the area of interest";
  }
  std::string first;
  for (const int columns : {1, 3})
    for (const std::size_t max_in_memory : {10u, 100'000u}) {
      Parts parts(whole, columns);
      MapContents contents = without_landmarks(whole);
      contents.parts = parts.parts();
      contents.parts.rejected = [&, count = contents.parts.count](std::size_t part) {
        auto own = std::make_shared<std::vector<Observation>>();
        for (std::size_t i = 0; i < rejected.size(); ++i)
          if (i * 7 % count == part) own->push_back(rejected[rejected.size() - 1 - i]);
        return own;
      };
      write_map(folder / "map.gpkg", contents, {.max_landmarks_in_memory = max_in_memory});
      const std::string bytes = file_bytes(folder / "map.gpkg");
      if (first.empty()) first = bytes;
      EXPECT_TRUE(bytes == first) << columns << " x " << columns << ", " << max_in_memory << " at once";
    }
  const auto stored = MapStore::open(folder / "map.gpkg").observations();
  EXPECT_EQ(std::ranges::count(stored, "seen twice in one image", &Observation::rejected), 100);
  EXPECT_EQ(std::ranges::count(stored, "", &Observation::rejected),
            static_cast<std::ptrdiff_t>(whole.observations.size()));
}

TEST(LandmarkParts, GiveTheSameBytesForEveryDivision) {
  const TemporaryFolder folder;
  const MapContents whole = held(3000);
  MapContents contents = without_landmarks(whole);
  std::string first;
  for (const int columns : {1, 2, 9})
    for (const std::size_t max_in_memory : {10u, 500u, 100'000u}) {
      Parts parts(whole, columns);
      contents.parts = parts.parts();
      EXPECT_EQ(write_map(folder / "map.gpkg", contents, {.max_landmarks_in_memory = max_in_memory})
                    .at("lamp_post"),
                3000);
      const std::string bytes = file_bytes(folder / "map.gpkg");
      if (first.empty()) first = bytes;
      EXPECT_TRUE(bytes == first) << columns << " x " << columns << ", " << max_in_memory << " at once";
    }
  EXPECT_THAT(validate_map(folder / "map.gpkg"), testing::IsEmpty());
}

// A large map has indexes of its largest values, and its rows are inserted in groups that end with a range.
TEST(LandmarkParts, GiveTheSameBytesToALargeMap) {
  const TemporaryFolder folder;
  MapContents whole = held(60'000);
  whole.observations.clear();
  MapContents contents = without_landmarks(whole);
  std::string first;
  for (const std::size_t max_in_memory : {7'000u, 100'000u}) {
    Parts parts(whole, 3);
    contents.parts = parts.parts();
    write_map(folder / "map.gpkg", contents, {.max_landmarks_in_memory = max_in_memory});
    const std::string bytes = file_bytes(folder / "map.gpkg");
    if (first.empty()) first = bytes;
    EXPECT_TRUE(bytes == first) << max_in_memory << " at once";
  }
  EXPECT_EQ(query_text(folder / "map.gpkg", "PRAGMA integrity_check"), "ok");
  EXPECT_EQ(query_text(folder / "map.gpkg",
                       "SELECT count(*) FROM sqlite_schema WHERE name = 'lamp_post_height_largest'"),
            "1");
}

TEST(LandmarkParts, GiveTheSameRowsAsLandmarksInMemory) {
  const TemporaryFolder folder;
  const MapContents whole = held(2000);
  Parts parts(whole, 6);
  MapContents contents = without_landmarks(whole);
  contents.parts = parts.parts();
  write_map(folder / "held.gpkg", whole);
  write_map(folder / "parts.gpkg", contents, {.max_landmarks_in_memory = 100});
  for (const char* sql :
       {"SELECT group_concat(id || hex(geom) || uid || height || observations) FROM lamp_post",
        "SELECT group_concat(hex(data)) FROM rtree_lamp_post_geom_node",
        "SELECT group_concat(l.uid || o.uid || o.pixel_y) FROM (SELECT * FROM lamp_post ORDER BY uid) l JOIN"
        "  lamp_post_observation r ON r.base_id = l.id JOIN observation o ON o.id = r.related_id"})
    EXPECT_EQ(query_text(folder / "parts.gpkg", sql), query_text(folder / "held.gpkg", sql)) << sql;
}

TEST(LandmarkParts, CombineWithLandmarksInMemory) {
  const TemporaryFolder folder;
  const MapContents whole = held(1000);
  MapContents some = whole;
  some.landmarks.resize(400), some.observations.resize(400);
  MapContents rest = whole;
  rest.landmarks.erase(rest.landmarks.begin(), rest.landmarks.begin() + 400);
  rest.observations.erase(rest.observations.begin(), rest.observations.begin() + 400);
  Parts parts(rest, 4);
  some.parts = parts.parts();
  write_map(folder / "whole.gpkg", whole);
  write_map(folder / "both.gpkg", some, {.max_landmarks_in_memory = 50});
  const char* sql = "SELECT group_concat(id || uid || height) FROM lamp_post";
  EXPECT_EQ(query_text(folder / "both.gpkg", sql), query_text(folder / "whole.gpkg", sql));
  const MapStore map = MapStore::open(folder / "both.gpkg");
  for (const Landmark& l : whole.landmarks) {
    const auto evidence = map.observations_of(l.uid);
    ASSERT_EQ(evidence.size(), 1u);
    EXPECT_EQ(evidence[0].position, l.position);
  }
  EXPECT_THAT(validate_map(folder / "both.gpkg"), testing::IsEmpty());
}

TEST(LandmarkParts, FewAreInMemoryAtOnce) {
  const TemporaryFolder folder;
  const MapContents whole = held(20'000);
  MapContents contents = without_landmarks(whole);
  Parts parts(whole, 40);
  contents.parts = parts.parts();
  write_map(folder / "map.gpkg", contents, {.max_landmarks_in_memory = 400});
  EXPECT_LE(parts.most(), 100u) << "one part's landmarks or evidence, of 40,000";
}

TEST(LandmarkParts, RejectInvalidContents) {
  const TemporaryFolder folder;
  const MapContents whole = held(100);
  MapContents contents = without_landmarks(whole);
  const auto message = [&](MapContents broken) -> std::string {
    Parts parts(broken, 3);
    contents.parts = parts.parts();
    try {
      write_map(folder / "map.gpkg", contents);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  };
  MapContents twice = whole;
  twice.landmarks[7].uid = twice.landmarks[70].uid;
  std::erase_if(twice.observations, [](const Observation& o) { return o.landmark_uid == "lp-7"; });
  EXPECT_THAT(message(twice), testing::HasSubstr("two landmarks have the same uid"));
  MapContents nowhere = whole;
  nowhere.landmarks[3].position.xyz.z() = std::nan("");
  EXPECT_THAT(message(nowhere), testing::HasSubstr("not finite"));
  EXPECT_FALSE(std::filesystem::exists(folder / "map.gpkg"));
}

TEST(DivideHilbertCurve, RangesAreConsecutiveAndOfLimitedSize) {
  const MapContents whole = held(5000);
  Envelope extent;
  for (const Landmark& l : whole.landmarks) extent.add(l.position.xyz.x(), l.position.xyz.y());
  const auto places = [&](std::size_t part, const auto& take) {
    for (std::size_t i = part; i < whole.landmarks.size(); i += 3)
      take(whole.landmarks[i].position.xyz.head<2>());
  };
  const std::vector<HilbertRange> ranges = divide_hilbert_curve(3, places, extent, 250);
  EXPECT_GE(ranges.size(), 20u);
  EXPECT_LE(ranges.size(), 30u);
  std::size_t all = 0;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    EXPECT_TRUE(i == 0 || ranges[i].first > ranges[i - 1].last);
    std::set<std::uint32_t> parts;
    std::size_t held_by = 0;
    for (std::size_t l = 0; l < whole.landmarks.size(); ++l) {
      if (!ranges[i].contains(hilbert_position(whole.landmarks[l].position.xyz.head<2>(), extent))) continue;
      parts.insert(static_cast<std::uint32_t>(l % 3));
      ++held_by;
    }
    EXPECT_LE(held_by, 250u);
    EXPECT_THAT(ranges[i].parts, testing::ElementsAreArray(parts));
    all += held_by;
  }
  EXPECT_EQ(all, 5000u);
}

// Memory of SQLite for a map that exceeds its cache of 64 MB.
TEST(LandmarkParts, TheCacheDoesNotGrow) {
  MapContents contents = scattered({.landmarks = 500'000, .with_evidence = 0});
  const TemporaryFolder folder;
  sqlite3_memory_highwater(1);
  write_map(folder / "map.gpkg", contents);
  EXPECT_GT(std::filesystem::file_size(folder / "map.gpkg"), 100'000'000u);
  EXPECT_LT(sqlite3_memory_highwater(0), 75'000'000);
}

}  // namespace
}  // namespace waymark::test
