// SPDX-License-Identifier: Apache-2.0
// Numbers, encodings and archives of tiles, against readers by the letter of the specifications.
#include <gmock/gmock.h>

#include <random>

#include "exporters/web/gzip.hpp"
#include "exporters/web/pmtiles_file.hpp"
#include "exporters/web/tile_id.hpp"
#include "exporters/web/vector_tile.hpp"
#include "tests/exporters/small_map.hpp"
#include "tests/support/slow_pmtiles.hpp"

namespace waymark::test {
using namespace exporters;
namespace {

TEST(TileIds, FollowTheCurveAsItIsDrawn) {
  for (int zoom = 0; zoom <= 7; ++zoom) {
    const auto cells = draw_hilbert(zoom);
    for (std::size_t i = 0; i < cells.size(); ++i)
      ASSERT_EQ(hilbert_of({zoom, cells[i].first, cells[i].second}), i) << "zoom " << zoom;
  }
}

TEST(TileIds, AreThoseOfTheSpecification) {
  EXPECT_EQ(pmtiles_id({0, 0, 0}), 0u);
  EXPECT_EQ(pmtiles_id({1, 0, 0}), 1u);
  EXPECT_EQ(pmtiles_id({1, 0, 1}), 2u);
  EXPECT_EQ(pmtiles_id({1, 1, 1}), 3u);
  EXPECT_EQ(pmtiles_id({1, 1, 0}), 4u);
  EXPECT_EQ(pmtiles_id({2, 0, 0}), 5u);
  EXPECT_EQ(pmtiles_id({12, 3423, 1763}), 19078479u);
}

TEST(TileIds, ACoarserZoomHasAQuarterOfTheIndex) {
  std::mt19937 random(7);
  for (int i = 0; i < 1000; ++i) {
    const TileId cell{27, std::uint32_t(random() & ((1u << 27) - 1)),
                      std::uint32_t(random() & ((1u << 27) - 1))};
    const int up = int(random() % 28);
    EXPECT_EQ(hilbert_of({27 - up, cell.column >> up, cell.row >> up}), hilbert_of(cell) >> (2 * up));
  }
}

TEST(Gzip, IsReadByOthersAndHasNoTime) {
  std::mt19937 random(3);
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{70000}}) {
    std::string bytes;
    for (std::size_t i = 0; i < size; ++i) bytes += char(random() % 7);
    const std::string file = gzip(bytes);
    EXPECT_EQ(gunzip(file), bytes);
    EXPECT_EQ(file.substr(4, 4), std::string(4, '\0'));
  }
}

TEST(VectorTile, APointIsThatOfTheSpecification) {
  const std::vector<std::string> keys{"a"};
  VectorLayer layer{.name = "l", .keys = keys};
  std::string properties;
  append_property(properties, 0, std::string("v"));
  layer.points.push_back({.id = 5, .x = 25, .y = 17, .properties = {properties}});
  // Section 4.3.5.1: a point at (25, 17) is [9 50 34]. Layer of 2 + 3 + 15 + 3 + 5 + 3 = 31 bytes: version 2,
  // name, feature (id 5, tags [0 0], POINT, geometry), key, value, extent 4096.
  EXPECT_EQ(encode_vector_tile({&layer, 1}),
            std::string("\x1a\x1f"
                        "\x78\x02"
                        "\x0a\x01l"
                        "\x12\x0d\x08\x05\x12\x02\x00\x00\x18\x01\x22\x03\x09\x32\x22"
                        "\x1a\x01"
                        "a"
                        "\x22\x03\x0a\x01v"
                        "\x28\x80\x20",
                        33));
}

TEST(VectorTile, ValuesOfAllKindsAreRead) {
  const std::vector<std::string> keys{"text", "real", "exact", "count", "unknown", "never"};
  std::vector<std::string> lists(200);
  VectorLayer layer{.name = "rock", .keys = keys};
  for (std::size_t i = 0; i < lists.size(); ++i) {
    append_property(lists[i], 0, "uid \xc3\xa4 " + std::to_string(i));
    append_property(lists[i], 1, double(i % 3) * 0.5);
    append_real(lists[i], 2, 1e-9 + double(i), true);
    append_property(lists[i], 3, std::int64_t(i) - 100);
    append_real(lists[i], 4, std::nan(""), true);
    append_property(lists[i], 4, std::nan(""));
    append_property(lists[i], 4, AttributeValue());
    layer.points.push_back({.id = i + 1, .x = std::uint32_t(i), .y = 4095, .properties = {lists[i]}});
  }
  const auto layers = read_vector_tile(encode_vector_tile({&layer, 1}));
  ASSERT_EQ(layers.size(), 1u);
  const auto& features = layers.at("rock");
  ASSERT_EQ(features.size(), lists.size());
  for (std::size_t i = 0; i < features.size(); ++i) {
    EXPECT_EQ(features[i].id, i + 1);
    EXPECT_EQ(features[i].x, std::int64_t(i));
    EXPECT_EQ(features[i].y, 4095);
    const decltype(features[i].properties) expected{{"text", "uid \xc3\xa4 " + std::to_string(i)},
                                                    {"real", double(i % 3) * 0.5},
                                                    {"exact", 1e-9 + double(i)},
                                                    {"count", double(i) - 100}};
    EXPECT_EQ(features[i].properties, expected);
  }
}

class Archive : public ::testing::Test {
 protected:
  SlowArchive written(const std::map<std::uint64_t, std::string>& tiles, const PmtilesHeader& header = {}) {
    PmtilesFile file(folder_ / "t.pmtiles", "t.pmtiles");
    for (const auto& [id, content] : tiles) file.add(id, content);
    file.finish(header);
    EXPECT_EQ(file.tile_count(), tiles.size());
    return read_archive(content_of(folder_ / "t.pmtiles"));
  }
  TemporaryFolder folder_;
};

TEST_F(Archive, EqualTilesAreStoredOnceAndRunsAreOneEntry) {
  const SlowArchive archive =
      written({{1, "sea"}, {2, "sea"}, {3, "sea"}, {4, "land"}, {5, "sea"}, {9, "sea"}, {10, "hill"}},
              {.min_zoom = 1, .max_zoom = 2, .metadata = R"({"a":1})"});
  EXPECT_EQ(archive.header.at("entries"), 5u);
  EXPECT_EQ(archive.header.at("contents"), 3u);
  EXPECT_EQ(archive.header.at("max_zoom"), 2u);
  EXPECT_EQ(archive.metadata, R"({"a":1})");
  EXPECT_EQ(archive.tiles.at({1, 0, 1}), "sea");
  EXPECT_EQ(archive.tiles.at({1, 1, 0}), "land");
  EXPECT_FALSE(archive.tiles.contains({0, 0, 0}));
}

TEST_F(Archive, ManyTilesGoToLeafDirectories) {
  std::mt19937 random(11);
  std::map<std::uint64_t, std::string> tiles;
  for (std::uint64_t id = 0; tiles.size() < 40000; id += 1 + random() % 50)
    tiles[id] = std::string(1 + random() % 40, char(random() % 256)) + std::to_string(random());
  const SlowArchive archive = written(tiles);
  EXPECT_GT(archive.leaves, 1u);
  ASSERT_EQ(archive.tiles.size(), tiles.size());
  for (const auto& [key, content] : archive.tiles) {
    const auto& [zoom, column, row] = key;
    ASSERT_EQ(tiles.at(pmtiles_id({zoom, column, row})), content);
  }
}

}  // namespace
}  // namespace waymark::test
