// SPDX-License-Identifier: Apache-2.0
// Components of a map file: geometries, the Hilbert curve, the packed RTree, TIFF tiles, styles.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "geodb/geopackage/geometry_blob.hpp"
#include "geodb/geopackage/provenance.hpp"
#include "geodb/layers/layer_style.hpp"
#include "geodb/rtree/hilbert.hpp"
#include "geodb/rtree/packed_rtree.hpp"
#include "geodb/sqlite/sqlite.hpp"
#include "tests/geodb/map_scenes.hpp"

namespace waymark::test {
using namespace geodb;
namespace {

TEST(Geometry, PointsReadBack) {
  const PointBlob blob = point_blob({1.5, -2.5, 3.25}, 4326);
  EXPECT_EQ(*point_of(blob), Eigen::Vector3d(1.5, -2.5, 3.25));
  EXPECT_EQ(srs_id_of(blob), 4326);
  EXPECT_TRUE(has_z(blob));
  EXPECT_EQ(*envelope(blob), (Envelope{1.5, -2.5, 1.5, -2.5}));
}

TEST(Geometry, PolygonsReadBackClosed) {
  const std::vector<std::vector<Eigen::Vector2d>> rings = {{{0, 0}, {4, 0}, {4, 3}}};
  const auto blob = polygons_blob(rings, -1);
  const auto read = polygons_of(blob);
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(read[0].size(), 4u);
  EXPECT_EQ(read[0].back(), Eigen::Vector2d(0, 0));
  EXPECT_EQ(*envelope(blob), (Envelope{0, 0, 4, 3}));
}

TEST(Geometry, NoPartOfABlobIsAGeometry) {
  const PointBlob point = point_blob({1, 2, 3}, 0);
  const auto polygon = polygons_blob(std::vector<std::vector<Eigen::Vector2d>>{{{0, 0}, {4, 0}, {4, 3}}}, 0);
  for (const std::span<const std::byte> whole :
       {std::span<const std::byte>(point), std::span<const std::byte>(polygon)})
    for (std::size_t size = 0; size < whole.size(); ++size) EXPECT_FALSE(envelope(whole.first(size))) << size;
}

TEST(HilbertCurve, StepsFromNeighbourToNeighbour) {
  std::map<std::uint32_t, std::pair<int, int>> at;  // the first 64 x 64 cells are the start of the curve
  for (int x = 0; x < 64; ++x)
    for (int y = 0; y < 64; ++y)
      at[hilbert_index(static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y))] = {x, y};
  ASSERT_EQ(at.size(), 4096u);
  for (std::uint32_t i = 1; i < 4096; ++i)
    ASSERT_EQ(std::abs(at.at(i).first - at.at(i - 1).first) + std::abs(at.at(i).second - at.at(i - 1).second),
              1)
        << i;
}

class PackedRtree : public ::testing::TestWithParam<int> {};

TEST_P(PackedRtree, IsWhatSqliteWouldAccept) {
  const TemporaryFolder folder;
  const sqlite::Database database(folder / "index.db", sqlite::OpenMode::create);
  database.execute("CREATE VIRTUAL TABLE rtree_t_geom USING rtree(id, minx, maxx, miny, maxy)");
  std::vector<IndexedBox> points;
  for (int i = 0; i < GetParam(); ++i) points.push_back({i + 1, i * 0.1, i * 0.1, 1e7 - i, 1e7 - i});
  fill_rtree(database, "t", points);
  sqlite::Statement check =
      database.prepare("SELECT rtreecheck('rtree_t_geom'), (SELECT count(*) FROM rtree_t_geom)");
  ASSERT_TRUE(check.step());
  EXPECT_EQ(check.text(0), "ok");
  EXPECT_EQ(check.integer(1), GetParam());
  check.reset();
  EXPECT_EQ(database.integer("SELECT count(*) FROM rtree_t_geom WHERE minx <= 2 AND maxx >= 1"),
            std::clamp(GetParam() - 10, 0, 11));
  for (int i = 0; i < 200; ++i) database.execute("INSERT INTO rtree_t_geom VALUES (NULL, 3, 3, 3, 3)");
  EXPECT_EQ(database.integer("SELECT rtreecheck('rtree_t_geom') = 'ok'"), 1)
      << "inserting goes on from there";
}

INSTANTIATE_TEST_SUITE_P(OfAnySize, PackedRtree,
                         ::testing::Values(0, 1, 50, 51, 52, 53, 2601, 2602, 2700, 20'000));

TEST(TimeStamp, IsWhatGeoPackageWants) {
  EXPECT_EQ(time_stamp("2026-11-21T07:21:14Z"), "2026-11-21T07:21:14.000Z");
  EXPECT_EQ(time_stamp("2026-11-21 07:21:14.5"), "2026-11-21T07:21:14.500Z");
  EXPECT_EQ(time_stamp("yesterday"), "1970-01-01T00:00:00.000Z");
  EXPECT_EQ(time_stamp(time_stamp_now()), time_stamp_now().substr(0, 20) + "000Z");
}

TEST(LayerStyle, IsWellFormedForEveryType) {
  TypeRegistry types;
  register_landmark_types(types);
  const TemporaryFolder folder;
  for (const auto& type : types)
    for (const std::string& document : {qml_style(type), sld_style(type)}) {
      const auto result =
          run_program("/usr/bin/python3 -c 'import sys, xml.dom.minidom as x; x.parse(sys.stdin)' <<'END'\n" +
                      document + "END\n");
      EXPECT_EQ(result.exit_code, 0) << type.name << result.output;
    }
}

}  // namespace
}  // namespace waymark::test
