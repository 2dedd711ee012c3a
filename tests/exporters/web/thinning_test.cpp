// SPDX-License-Identifier: Apache-2.0
#include "exporters/web/thinning.hpp"

#include <gmock/gmock.h>

#include <map>
#include <random>
#include <set>

namespace waymark::test {
using namespace exporters;
namespace {

constexpr std::uint64_t kWorld = std::uint64_t{1} << kStepZoom;

/// Landmarks in clusters, so that cells at all zooms hold several; some coincide.
std::vector<WebLandmark> made_landmarks(unsigned seed, std::size_t count) {
  std::mt19937_64 random(seed);
  std::vector<WebLandmark> made(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t spread = std::uint64_t{1} << (random() % kStepZoom);
    made[i].x = (kWorld / 3 + random() % spread) % kWorld;
    made[i].y = (kWorld / 5 * 2 + random() % spread) % kWorld;
    if (i > 0 && i % 9 == 0) made[i].x = made[i - 1].x, made[i].y = made[i - 1].y;
    made[i].layer = static_cast<std::uint32_t>(i % 2);
    made[i].rank = static_cast<std::uint32_t>(i / 2);
    constexpr int zoom = kMaxWebZoom + kCellZoom;
    made[i].curve = hilbert_of({zoom, std::uint32_t(made[i].x >> (kStepZoom - zoom)),
                                std::uint32_t(made[i].y >> (kStepZoom - zoom))});
  }
  std::ranges::sort(made, {}, [](const WebLandmark& l) { return std::tuple(l.curve, l.layer, l.rank); });
  return made;
}

/// The foremost of each cell and the number of the others, cell by cell.
std::map<std::size_t, std::int64_t> thin_out_slowly(const std::vector<WebLandmark>& all, int zoom) {
  std::map<std::tuple<std::uint64_t, std::uint64_t, std::uint32_t>, std::vector<std::size_t>> cells;
  const std::uint64_t size = kWorld >> (zoom + kCellZoom);
  for (std::size_t i = 0; i < all.size(); ++i)
    cells[{all[i].x / size, all[i].y / size, all[i].layer}].push_back(i);
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::size_t> tiles;
  for (const WebLandmark& one : all) ++tiles[{one.x / (kWorld >> zoom), one.y / (kWorld >> zoom)}];
  std::map<std::size_t, std::int64_t> shown;
  for (const auto& [cell, members] : cells) {
    const WebLandmark& any = all[members.front()];
    if (tiles[{any.x / (kWorld >> zoom), any.y / (kWorld >> zoom)}] <= 1000) {
      for (const std::size_t i : members) shown[i] = 0;
      continue;
    }
    std::size_t best = members.front();
    for (const std::size_t i : members)
      if (all[i].rank < all[best].rank) best = i;
    shown[best] = std::int64_t(members.size()) - 1;
  }
  return shown;
}

TEST(Thinning, ShowsTheForemostOfEachCellOfAFullTile) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    const auto all = made_landmarks(seed, 1900);
    for (int zoom = 0; zoom < kMaxWebZoom; ++zoom) {
      std::map<std::size_t, std::int64_t> shown;
      for (const ShownLandmark& one : thin_out(all, zoom)) shown[one.landmark] = one.hidden;
      ASSERT_EQ(shown, thin_out_slowly(all, zoom)) << "seed " << seed << ", zoom " << zoom;
    }
  }
}

TEST(Thinning, KeepsAtFinerZoomsWhatItShows) {
  const auto all = made_landmarks(42, 3000);
  std::set<std::size_t> coarser;
  for (int zoom = 0; zoom < kMaxWebZoom; ++zoom) {
    std::set<std::size_t> shown;
    std::int64_t total = 0;
    for (const ShownLandmark& one : thin_out(all, zoom)) {
      shown.insert(one.landmark);
      total += 1 + one.hidden;
    }
    EXPECT_TRUE(std::ranges::includes(shown, coarser)) << zoom;
    EXPECT_EQ(total, 3000) << zoom;
    coarser = shown;
  }
}

TEST(Thinning, TilesAscendAndHoldTheirLandmarks) {
  const auto all = made_landmarks(5, 2000);
  for (const int zoom : {0, 3, 9, 22}) {
    const auto shown = all_of(all);
    std::size_t next = 0;
    std::uint64_t last = 0;
    for (const LandmarkTile& tile : tiles_of(all, shown, zoom)) {
      EXPECT_EQ(tile.first, next);
      EXPECT_TRUE(next == 0 || pmtiles_id(tile.id) > last);
      last = pmtiles_id(tile.id);
      for (std::size_t i = 0; i < tile.count; ++i, ++next) {
        EXPECT_EQ(all[shown[next].landmark].x / (kWorld >> zoom), tile.id.column);
        EXPECT_EQ(all[shown[next].landmark].y / (kWorld >> zoom), tile.id.row);
      }
    }
    EXPECT_EQ(next, all.size());
  }
}

TEST(Thinning, TheTopZoomIsFineAndHasNoFullTiles) {
  std::mt19937_64 random(1);
  const auto spread_over = [&](std::uint64_t width, std::size_t count) {
    auto all = made_landmarks(9, count);
    for (WebLandmark& one : all) {
      one.x = kWorld / 2 + random() % width;
      one.y = kWorld / 2 + random() % width;
      constexpr int zoom = kMaxWebZoom + kCellZoom;
      one.curve = hilbert_of(
          {zoom, std::uint32_t(one.x >> (kStepZoom - zoom)), std::uint32_t(one.y >> (kStepZoom - zoom))});
    }
    std::ranges::sort(all, {}, [](const WebLandmark& l) { return std::tuple(l.curve, l.layer, l.rank); });
    return all;
  };
  constexpr double earth = 4e7;
  // Half the world / 100,000 is 1 / (4096 * 2^5.6).
  EXPECT_EQ(top_zoom(spread_over(kWorld / 2, 100), earth), 6);
  // A 1024th of the world is ten zooms finer; its tiles have at most 1,000 of 60,000 from zoom 13 or 14 on.
  EXPECT_EQ(top_zoom(spread_over(kWorld >> 10, 60000), earth), 15);
  // A millimetre of the Earth is below the steps of the finest zoom.
  EXPECT_EQ(top_zoom(spread_over(1000, 10), earth), kMaxWebZoom);
  // 40,000 in one tile of zoom 14: 2,500 in a tile of zoom 16, 625 of zoom 17. A step is 1 mm from zoom 10
  // on.
  EXPECT_EQ(top_zoom(spread_over(kWorld >> 14, 40000), earth * 1e-4), 17);
}

TEST(WebBounds, AreNarrowAcrossTheEdgeOfTheWorld) {
  std::vector<WebLandmark> all(3);
  all[0].x = kWorld - kWorld / 64;
  all[1].x = kWorld / 64;
  all[2].x = 5;
  for (WebLandmark& one : all) one.y = kWorld / 4;
  const WebBounds bounds = bounds_of(all);
  EXPECT_DOUBLE_EQ(bounds.west, 1 - 1.0 / 64);
  EXPECT_DOUBLE_EQ(bounds.east, 1 + 1.0 / 64);
  EXPECT_DOUBLE_EQ(bounds.north, 0.25);
}

}  // namespace
}  // namespace waymark::test
