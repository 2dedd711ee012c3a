// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <barrier>
#include <cmath>
#include <cstring>
#include <fstream>
#include <thread>

#include "core/random.hpp"
#include "importers/points/canopy.hpp"
#include "importers/points/canopy_codec.hpp"
#include "importers/points/las_catalogue.hpp"
#include "pipeline/forest/find_trees.hpp"
#include "tests/importers/raster_maker.hpp"
#include "tests/support/laz_writer.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

struct LasFile {
  std::string name = "points.las";
  int minor = 2, format = 1, length = 28;
  std::vector<importers::LasPoint> points;
  int epsg = 32633, vertical_unit = 0;
  bool legacy_zero = false, compressed = false;
  std::uint64_t promised = 0;  ///< number of points in the header, if larger than the actual one
};

void put(std::string& bytes, std::size_t at, const auto& value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

std::string written(const LasFile& las) {
  const std::size_t head = las.minor >= 4 ? 375 : 227;
  std::string keys(8 + 8 * 2, '\0');
  put(keys, 0, std::uint16_t{1}), put(keys, 2, std::uint16_t{1}), put(keys, 6, std::uint16_t{2});
  put(keys, 8, std::uint16_t{3072}), put(keys, 12, std::uint16_t{1});
  put(keys, 14, static_cast<std::uint16_t>(las.epsg));
  put(keys, 16, std::uint16_t{4099}), put(keys, 20, std::uint16_t{1});
  put(keys, 22, static_cast<std::uint16_t>(las.vertical_unit));
  std::string record(54, '\0');
  std::memcpy(record.data() + 2, "LASF_Projection", 15);
  put(record, 18, std::uint16_t{34735}), put(record, 20, static_cast<std::uint16_t>(keys.size()));
  std::string bytes(head, '\0');
  std::memcpy(bytes.data(), "LASF", 4);
  bytes[24] = 1, bytes[25] = static_cast<char>(las.minor);
  put(bytes, 94, static_cast<std::uint16_t>(head));
  put(bytes, 96, static_cast<std::uint32_t>(head + record.size() + keys.size()));
  put(bytes, 100, std::uint32_t{1});
  bytes[104] = static_cast<char>(las.format | (las.compressed ? 0x80 : 0));
  put(bytes, 105, static_cast<std::uint16_t>(las.length));
  const std::uint64_t count = las.promised ? las.promised : las.points.size();
  if (!las.legacy_zero) put(bytes, 107, static_cast<std::uint32_t>(count));
  for (const std::size_t i : {0, 1, 2}) put(bytes, 131 + 8 * i, 0.001);
  put(bytes, 155, 500000.0), put(bytes, 163, 5000000.0);
  if (las.minor >= 4) put(bytes, 247, count);
  bytes += record + keys;
  for (const importers::LasPoint& p : las.points) {
    std::string one(static_cast<std::size_t>(las.length), '\0');
    put(one, 0, static_cast<std::int32_t>(std::lround((p.x - 500000) * 1000)));
    put(one, 4, static_cast<std::int32_t>(std::lround((p.y - 5000000) * 1000)));
    put(one, 8, static_cast<std::int32_t>(std::lround(p.z * 1000)));
    const bool wide = las.format >= 6;
    one[14] = static_cast<char>(p.return_number | (2 << (wide ? 4 : 3)));
    one[wide ? 16 : 15] = static_cast<char>(p.classification);
    if (p.withheld) one[15] = static_cast<char>(one[15] | (wide ? 4 : 0x80));
    bytes += one;
  }
  return write_text(las.name, bytes);
}

std::string refusal_of_las(const LasFile& las) {
  const std::string path = written(las);
  return message_of([&] { importers::import_canopy({.las = {path}}); });
}

std::vector<importers::LasPoint> some_points() {
  return {{500001.5, 5000002.25, 310.125, 2, 1, false},
          {500003, 5000004, 322, 5, 2, false},
          {500004, 5000001, 999, 18, 1, false},
          {500005, 5000001, 318, 5, 1, true}};
}

TEST(Las, EveryPointFormatIsRead) {
  constexpr int kLength[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  for (int format = 0; format <= 10; ++format) {
    LasFile las{.minor = format >= 6 ? 4 : 2,
                .format = format,
                .length = kLength[format] + format % 3,
                .points = some_points()};
    las.legacy_zero = format >= 6;
    const importers::LasHeader header = importers::read_las_header(written(las));
    ASSERT_EQ(header.points, 4U) << format;
    ASSERT_TRUE(header.crs);
    EXPECT_EQ(header.crs->code(), "32633");
    const auto points = importers::read_las_points(header, 0, 4);
    EXPECT_NEAR(points[0].x, 500001.5, 1e-6);
    EXPECT_NEAR(points[0].z, 310.125, 1e-6);
    EXPECT_EQ(points[0].classification, 2);
    EXPECT_EQ(points[1].return_number, 2);
    EXPECT_EQ(points[1].return_count, 2);
    EXPECT_EQ(points[2].classification, 18);
    EXPECT_TRUE(points[3].withheld);
    EXPECT_FALSE(points[0].withheld);
  }
}

TEST(Las, SaysWhatIsWrong) {
  LasFile good{.points = some_points()};
  LasFile las = good;
  las.compressed = true;
  EXPECT_THAT(refusal_of_las(las),
              AllOf(HasSubstr("compressed (LAZ)"), HasSubstr("record that says how is missing")));
  las = good, las.promised = 100;
  EXPECT_THAT(refusal_of_las(las), HasSubstr("truncated: its header states 100 points, it holds 4"));
  las = good, las.length = 20;
  EXPECT_THAT(refusal_of_las(las),
              HasSubstr("a point record of format 1 has 28 bytes at least, the header says 20"));
  las = good, las.format = 11;
  EXPECT_THAT(refusal_of_las(las), HasSubstr("point format 11"));
  las = good, las.minor = 5;
  EXPECT_THAT(refusal_of_las(las), HasSubstr("LAS 1.5 is not known"));
  las = good;
  for (importers::LasPoint& p : las.points) p.classification = 1;
  EXPECT_THAT(refusal_of_las(las),
              AllOf(HasSubstr("no point is classified as ground (class 2)"), HasSubstr("classify it first")));
  las = good, las.points.clear();
  EXPECT_THAT(refusal_of_las(las), HasSubstr("no points"));
  const auto text = write_text("no.las", "not a LAS file at all");
  EXPECT_THAT(message_of([&] { importers::import_canopy({.las = {text}}); }),
              HasSubstr("does not begin with LASF"));
  EXPECT_THAT(message_of([&] { importers::import_canopy({.las = {"/nowhere/a.las"}}); }),
              HasSubstr("does not exist"));
  const auto half = write_text("half.las", std::string("LASF") + std::string(100, '\0'));
  EXPECT_THAT(message_of([&] { importers::import_canopy({.las = {half}}); }),
              HasSubstr("ends within its header"));
}

// Of threads that decode a run at once, one keeps it for the others; all must read their own to its end.
TEST(Las, ManyThreadsVisitOneRun) {
  LasFile las;
  for (int i = 0; i < 30000; ++i)
    las.points.push_back({500000 + 0.001 * (i % 1000), 5000000 + 0.001 * (i / 1000.0), 300, 1, 1, false});
  const std::string path = written(las);
  for (int trial = 0; trial < 20; ++trial) {
    const importers::LasCatalogue catalogue({path}, 1 << 20);
    std::barrier start(6);
    std::vector<std::uint64_t> seen(6, 0);
    std::vector<std::jthread> threads;
    for (std::uint64_t& count : seen)
      threads.emplace_back([&] {
        start.arrive_and_wait();
        catalogue.visit(catalogue.box(), [&](const importers::LasPoint& p) { count += p.z == 300; });
      });
    threads.clear();
    for (const std::uint64_t count : seen) EXPECT_EQ(count, las.points.size());
  }
}

TEST(Las, PointsFarApartAreRefusedRatherThanGridded) {
  LasFile las{.points = some_points()};
  las.points[0].x += 300e3, las.points[0].y += 300e3;  // 2e10 cells for two usable points
  EXPECT_THAT(refusal_of_las(las), AllOf(HasSubstr("points lie 3e+05 x 3e+05 m apart"),
                                         HasSubstr("points.las"), HasSubstr("a wild point")));
}

TEST(Las, FilesOfDifferentPlacesOfReferenceAreRefused) {
  LasFile a{.name = "a.las", .points = some_points()}, b{.name = "b.las", .points = some_points()};
  b.epsg = 32632;
  const std::vector<std::string> files{written(a), written(b)};
  EXPECT_THAT(message_of([&] { importers::import_canopy({.las = files}); }),
              AllOf(HasSubstr("EPSG:32633"), HasSubstr("EPSG:32632")));
  b.epsg = 4326;
  const auto degrees = written(b);
  EXPECT_THAT(message_of([&] { importers::import_canopy({.las = {degrees}}); }), HasSubstr("in degrees"));
}

// Cones 12 m high on a slope, four points a square metre.
std::vector<importers::LasPoint> cones(double height_unit = 1) {
  Random random(5, "cones");
  std::vector<importers::LasPoint> points;
  for (int i = 0; i < 4 * 60 * 60; ++i) {
    const double x = 60 * random.uniform(), y = 60 * random.uniform(), ground = 300 + 0.3 * x;
    double above = 0;
    for (const auto& [cx, cy] : {std::pair{15.0, 15.0}, {45.0, 15.0}, {30.0, 45.0}})
      above = std::max(above, 12 - 3 * std::hypot(x - cx, y - cy));
    const auto add = [&](double z, int type, int number) {
      points.push_back({500000 + x, 5000000 + y, z / height_unit, static_cast<std::uint8_t>(type),
                        static_cast<std::uint8_t>(number), false});
    };
    add(ground + above, above > 0 ? 5 : 2, 1);
    if (above > 0 && random.uniform() < 0.2) add(ground, 2, 2);
  }
  return points;
}

TEST(PointCanopy, TreesStandOnTheSlope) {
  const auto canopy = importers::import_canopy({.las = {written({.points = cones()})}});
  EXPECT_NEAR(canopy->geometry().where.dx, 0.5, 1e-12);
  const GridGeometry& grid = canopy->geometry();
  const auto trees =
      find_trees(*canopy, {0, 0, grid.columns, grid.rows}, {.forest = forest_preset("conifer")});
  ASSERT_EQ(trees.size(), 3U);
  for (const DetectedTree& tree : trees) {
    EXPECT_NEAR(tree.height, 12, 0.8);
    EXPECT_NEAR(canopy->ground_elevation(tree.top.column, tree.top.row),
                300 + 0.3 * (grid.where.x(static_cast<double>(tree.top.column)) - 500000), 0.3);
    EXPECT_NEAR(tree.crown_diameter, 6.5, 1.2);  // down to 0.3 of the height: 5.6 m, its rim included
  }
}

TEST(PointCanopy, ManyFilesAreOneCatalogue) {
  const auto all = cones();
  std::vector<importers::LasPoint> west, east;
  for (const importers::LasPoint& p : all) (p.x < 500030 ? west : east).push_back(p);
  const auto one = importers::import_canopy({.las = {written({.name = "all.las", .points = all})}});
  const auto two = importers::import_canopy(
      {.las = {written({.name = "w.las", .points = west}), written({.name = "e.las", .points = east})}});
  const Window cells{0, 0, one->geometry().columns, one->geometry().rows};
  EXPECT_EQ(one->read(cells), two->read(cells));
}

TEST(PointCanopy, FeetBecomeMetres) {
  const auto canopy =
      importers::import_canopy({.las = {written({.points = cones(0.3048), .vertical_unit = 9002})}});
  EXPECT_THAT(canopy->warnings(), Contains(HasSubstr("heights are in feet")));
  float highest = 0;
  const Grid<float> heights = canopy->read({0, 0, 120, 120});
  for (const float h : heights.cells()) highest = std::max(highest, h);
  EXPECT_NEAR(highest, 12, 0.8);
}

// The slope under the cones on cells of 2 m, from x = 500000 + `west` on, raised by `offset`.
std::string slope(double west = -10, double offset = 0, const std::string& name = "slope.tif") {
  Grid<double> cells(40, 40);
  for (std::int64_t r = 0; r < 40; ++r)
    for (std::int64_t c = 0; c < 40; ++c)
      cells(c, r) = 300 + offset + 0.3 * (west + 1 + 2 * static_cast<double>(c));
  return write_raster({.path = "/vsimem/" + name,
                       .cells = cells,
                       .type = GDT_Float64,
                       .transform = GeoTransform{500000 + west, 2, 0, 5000070, 0, -2}});
}

TEST(PointCanopy, HeightsAreAboveTheTerrainModelThatIsGiven) {
  auto points = cones();
  for (importers::LasPoint& p : points) p.classification = 1;
  const auto by_terrain = [&](const std::string& name, std::vector<importers::LasPoint> all,
                              const std::string& dtm) {
    return importers::import_canopy(
        {.dtm = {dtm}, .las = {written({.name = name, .points = std::move(all)})}});
  };
  const auto canopy = by_terrain("plain.las", points, slope());
  EXPECT_THAT(canopy->warnings(), ::testing::IsEmpty());
  ASSERT_TRUE(canopy->terrain());
  const GridGeometry& grid = canopy->geometry();
  const Window all{0, 0, grid.columns, grid.rows};
  const auto trees = find_trees(*canopy, all, {.forest = forest_preset("conifer")});
  ASSERT_EQ(trees.size(), 3U);
  for (const DetectedTree& tree : trees) EXPECT_NEAR(tree.height, 12, 0.8);
  // On a plane the terrain is exact at any cell, and bare ground has no height, at the borders of blocks too.
  const Grid<float> heights = canopy->read(all);
  for (std::int64_t c = 4; c < grid.columns - 4; ++c) {
    EXPECT_NEAR(canopy->ground_elevation(c, 2), 300 + 0.3 * (grid.where.x(static_cast<double>(c)) - 500000),
                1e-3);
    EXPECT_NEAR(heights(c, 60), 0, 0.01) << c;
  }
  // A job that continues opens the same canopy.
  const Canopies stored = importers::decode_canopies(importers::encode_canopies({canopy}));
  EXPECT_EQ(stored[0]->read(all), heights);
  // Where the terrain ends, nothing is known.
  const auto half = by_terrain("plain.las", points, slope(34, 0, "half.tif"));
  EXPECT_THAT(half->warnings(), Contains(HasSubstr("does not cover all points")));
  const Grid<float> known = half->read(all);
  EXPECT_EQ(known(20, 60), kNoCanopy);
  EXPECT_NEAR(known(grid.columns - 10, 60), 0, 0.01);
  EXPECT_EQ(find_trees(*half, all, {.forest = forest_preset("conifer")}).size(), 1U);
}

TEST(PointCanopy, ATerrainOfAnotherDatumIsRefused) {
  const auto points = cones();
  auto plain = points;
  for (importers::LasPoint& p : plain) p.classification = 1;
  const auto said = [&](const std::vector<importers::LasPoint>& all, double offset) {
    const std::string las = written({.points = all}), dtm = slope(-10, offset);
    return message_of([&] { importers::import_canopy({.dtm = {dtm}, .las = {las}}); });
  };
  EXPECT_THAT(said(points, -47),
              AllOf(HasSubstr("the ground points of the laser lie 47.0 m above the terrain"),
                    HasSubstr("above the ellipsoid")));
  EXPECT_THAT(said(plain, 47),
              AllOf(HasSubstr("the lowest points of the laser lie 47"), HasSubstr("below the terrain")));
  const auto near =
      importers::import_canopy({.dtm = {slope(-10, 2.5)}, .las = {written({.points = points})}});
  EXPECT_THAT(near->warnings(), Contains(HasSubstr("lie 2.5 m below the terrain model")));
  write_raster({.path = "/vsimem/far.tif", .cells = Grid<double>(4, 4, 300.0)});
  EXPECT_THAT(message_of([&] {
                importers::import_canopy({.dtm = {"/vsimem/far.tif"}, .las = {written({.points = points})}});
              }),
              HasSubstr("do not overlap"));
}

// The cones as records; 0.001 m from 500000 and 5000000.
LazFile raw_cones(int format) {
  LazFile file{.format = format};
  const auto points = cones();
  for (std::size_t i = 0; i < points.size(); ++i) {
    RawPoint p;
    p.at = {static_cast<std::int32_t>(std::lround((points[i].x - 500000) * 1000)),
            static_cast<std::int32_t>(std::lround((points[i].y - 5000000) * 1000)),
            static_cast<std::int32_t>(std::lround(points[i].z * 1000))};
    p.classification = points[i].classification, p.number = points[i].return_number;
    p.returns = p.number, p.time = 1000 + static_cast<std::int64_t>(i);
    if (i % 5000 == 0) file.chunks.emplace_back();
    file.chunks.back().push_back(p);
  }
  return file;
}

Grid<float> heights_of(const std::string& name, const std::string& bytes) {
  const auto canopy = importers::import_canopy({.las = {write_text(name, bytes)}});
  return canopy->read({0, 0, canopy->geometry().columns, canopy->geometry().rows});
}

TEST(PointCanopy, CompressedPointsMakeTheSameCanopy) {
  const Grid<float> plain = heights_of("cones.las", las_bytes(raw_cones(6)));
  EXPECT_EQ(plain, heights_of("one.laz", laz_bytes(raw_cones(1))));
  EXPECT_EQ(plain, heights_of("six.laz", laz_bytes(raw_cones(6))));
  EXPECT_EQ(plain, heights_of("cones.copc.laz", copc_bytes(raw_cones(6), 4)));
}

}  // namespace
}  // namespace waymark::test
