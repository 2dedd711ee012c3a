// SPDX-License-Identifier: Apache-2.0
// Landmarks numbered on the disk against those numbered in memory, on tables with ties and repeated places.
#include "workflows/mapping/staged_landmarks.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <tuple>

#include "core/error.hpp"
#include "core/locked_folder.hpp"
#include "core/random.hpp"
#include "landmarks/semantic_map.hpp"
#include "workflows/registries.hpp"

namespace waymark::test {
using namespace workflows;
namespace {

struct MadeTable {
  Crs crs = Crs::from_text("EPSG:32632");
  std::vector<Landmark> landmarks;

  /// Positions from a few places, so that several landmarks share one, or lie in the same centimetre. Some
  /// features are unknown.
  MadeTable(std::uint64_t seed, int count) {
    Random random(seed);
    const auto pick = [&](int n) { return static_cast<int>(random.uniform(0, n)); };
    for (int i = 0; i < count; ++i) {
      Landmark landmark;
      landmark.type = static_cast<TypeId>(pick(3));
      const double grain = pick(4) ? 1 : 0.003;
      landmark.position.xyz = {500000 + grain * pick(40), 5e6 + grain * pick(40), pick(2) * 1.0};
      landmark.covariance = Eigen::Matrix3d::Identity();
      landmark.features.resize(all_types()[landmark.type].features.size());
      if (!landmark.features.empty() && pick(2)) landmark.features[0].value = pick(3);
      if (pick(5) == 0) landmark.uid = "own-" + std::to_string(i);
      landmark.confidence = (i + 0.5) / count;  // names the landmark
      landmarks.push_back(std::move(landmark));
    }
  }
};

std::map<double, std::string> uids_on_disk(const MadeTable& table, std::size_t* parts = nullptr) {
  const LockedFolder folder(std::filesystem::temp_directory_path());
  StagedLandmarks staged(all_types(), folder.path());
  for (Landmark landmark : table.landmarks) staged.add(std::move(landmark));
  const geodb::LandmarkParts all = staged.finish(table.crs, "table.csv");
  if (parts) *parts = all.count;
  std::map<double, std::string> uids;
  for (std::size_t number = 0; number < all.count; ++number) {
    const auto part = all.landmarks(number);
    for (const Landmark& landmark : *part)
      EXPECT_TRUE(uids.emplace(landmark.confidence, landmark.uid).second);
  }
  return uids;
}

std::map<double, std::string> uids_in_memory(const MadeTable& table) {
  std::vector<Landmark> sorted = table.landmarks;
  std::ranges::stable_sort(sorted, [](const Landmark& a, const Landmark& b) {
    const auto place = [](const Landmark& l) {
      const Eigen::Vector3d& at = l.position.xyz;
      return std::tuple(l.type, at.x(), at.y(), at.z());
    };
    if (place(a) != place(b)) return place(a) < place(b);
    for (std::size_t i = 0; i < a.features.size(); ++i) {
      const double x = a.features[i].value, y = b.features[i].value;
      if (std::isnan(x) != std::isnan(y)) return std::isnan(y);
      if (x > y || y > x) return x > y;
    }
    return a.uid < b.uid;
  });
  std::vector<Landmark> numbered = sorted;
  assign_uids(all_types(), table.crs, numbered);
  std::map<double, std::string> uids;
  for (std::size_t i = 0; i < sorted.size(); ++i)
    uids[sorted[i].confidence] = sorted[i].uid.empty() ? numbered[i].uid : sorted[i].uid;
  return uids;
}

TEST(StagedLandmarks, HaveTheUidsOfNumberingInMemory) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const MadeTable table(seed, seed == 0 ? 25'000 : 3000);
    std::size_t parts = 0;
    EXPECT_EQ(uids_on_disk(table, &parts), uids_in_memory(table)) << "seed " << seed;
    EXPECT_EQ(parts > 1, seed == 0);
  }
}

TEST(StagedLandmarks, AtOnePlaceAreDividedIntoParts) {
  MadeTable table(1, 25'000);
  for (Landmark& landmark : table.landmarks) landmark.position.xyz = {0, 0, 0}, landmark.uid.clear();
  table.landmarks.front().position.xyz = {1e6, 1e6, 0};
  std::size_t parts = 0;
  EXPECT_EQ(uids_on_disk(table, &parts), uids_in_memory(table));
  EXPECT_GE(parts, 3u);
}

TEST(StagedLandmarks, RefuseAUidThatATableGivesTwiceOrThatAPlaceHas) {
  MadeTable table(2, 3000);
  const std::map<double, std::string> uids = uids_in_memory(table);
  const auto refusal = [&](const std::string& uid) -> std::string {
    MadeTable twice = table;
    twice.landmarks.back().uid = uid;
    try {
      uids_on_disk(twice);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const TypeId type = table.landmarks.back().type;
  for (const bool given : {true, false}) {
    const auto other = std::ranges::find_if(table.landmarks, [&](const Landmark& l) {
      return l.type == type && l.uid.empty() != given && l.confidence != table.landmarks.back().confidence;
    });
    const std::string uid = uids.at(other->confidence);
    EXPECT_THAT(refusal(uid), testing::HasSubstr("two rows have the uid '" + uid + "'"));
  }
}

TEST(StagedLandmarks, OfAnEmptyTableHaveNoParts) {
  std::size_t parts = 1;
  EXPECT_TRUE(uids_on_disk(MadeTable(0, 0), &parts).empty());
  EXPECT_EQ(parts, 0u);
}

}  // namespace
}  // namespace waymark::test
