// SPDX-License-Identifier: Apache-2.0
// Every reader of DEMs, images and laser points, given hundreds of damaged files.
#include "exporters/las_file.hpp"
#include "importers/images/list_images.hpp"
#include "importers/points/canopy.hpp"
#include "importers/rasters/dem.hpp"
#include "tests/support/laz_writer.hpp"
#include "tests/support/mutated_files.hpp"

namespace waymark::test {
namespace {

TEST_F(MutatedFiles, OfDems) {
  check("dem.tif", dem_bytes(folder_), Content::binary, 200, [](const std::string& path) {
    const auto dem = importers::import_dem({.files = {path}});
    const GridGeometry& grid = dem->geometry();
    dem->read({0, 0, std::min<std::int64_t>(grid.columns, 64), std::min<std::int64_t>(grid.rows, 64)});
  });
}

TEST_F(MutatedFiles, OfTextRasters) {
  check("dem.asc",
        "ncols 4\nnrows 3\nxllcorner 500000\nyllcorner 5000000\ncellsize 10\nNODATA_value -9999\n"
        "1 2 3 4\n5 6 7 8\n9 10 -9999 12\n",
        Content::text, 150, [](const std::string& path) {
          const auto dem = importers::import_dem({.files = {path}, .crs = "EPSG:32633"});
          const GridGeometry& grid = dem->geometry();
          dem->read({0, 0, std::min<std::int64_t>(grid.columns, 64), std::min<std::int64_t>(grid.rows, 64)});
        });
}

TEST_F(MutatedFiles, OfImages) {
  check("a.png", dem_bytes(folder_), Content::binary, 100, [](const std::string& path) {
    // A fault of one image is a warning.
    const importers::ListedImages listed =
        importers::list_images({.files = {path}, .import = {.crs = "EPSG:32633"}});
    if (!listed.warnings.empty()) throw Error(ErrorCode::input, listed.warnings[0], path);
  });
}

TEST_F(MutatedFiles, OfLaserPoints) {
  {
    exporters::LasFile las(folder_ / "made.las", Crs::from_text("EPSG:32633"), 500000, 5000000);
    for (int i = 0; i < 400; ++i)
      las.add({.x = 500000.0 + i % 20,
               .y = 5000000.0 + i / 20,
               .z = 100 + (i % 7 == 0) * 12.0,
               .kind = static_cast<std::uint8_t>(i % 7 ? 2 : 5)});
    las.close();
  }
  check(
      "points.las", read_text(folder_ / "made.las", "the points"), Content::binary, 150,
      [](const std::string& path) {
        const auto canopy = importers::import_canopy({.las = {path}});
        const GridGeometry& grid = canopy->geometry();
        canopy->read({0, 0, std::min<std::int64_t>(grid.columns, 64), std::min<std::int64_t>(grid.rows, 64)});
      });
}

void read_canopy(const std::string& path) {
  const auto canopy = importers::import_canopy({.las = {path}});
  const GridGeometry& grid = canopy->geometry();
  canopy->read({0, 0, std::min<std::int64_t>(grid.columns, 64), std::min<std::int64_t>(grid.rows, 64)});
}

// A slope of 30 x 30 m with bumps, a return per square metre.
LazFile compressed_slope(int format) {
  LazFile file{.format = format, .origin = {500000, 5000000, 100}, .scale = 0.01};
  for (int i = 0; i < 900; ++i) {
    RawPoint p;
    p.at = {i % 30 * 100 - 1500, i / 30 * 100 - 1500, i % 30 + (i % 7 == 0) * 1200};
    p.classification = i % 7 == 0 ? 5 : 2;
    p.intensity = static_cast<std::uint16_t>(i * 7 % 300), p.time = 1000 + i / 3 * 20;
    if (i % 450 == 0) file.chunks.emplace_back();
    file.chunks.back().push_back(p);
  }
  return file;
}

TEST_F(MutatedFiles, OfCompressedPoints) {
  for (const int format : {1, 3, 6, 8})
    check("points.laz", laz_bytes(compressed_slope(format)), Content::binary, 60, read_canopy);
}

TEST_F(MutatedFiles, OfCompressedPointsOfVaryingChunks) {
  LazFile file = compressed_slope(6);
  file.variable = file.table_at_end = true;
  check("points.laz", laz_bytes(file), Content::binary, 150, read_canopy);
}

TEST_F(MutatedFiles, OfOctreesOfPoints) {
  check("points.copc.laz", copc_bytes(compressed_slope(6), 3), Content::binary, 200, read_canopy);
}

}  // namespace
}  // namespace waymark::test
