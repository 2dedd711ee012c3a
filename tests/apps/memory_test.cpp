// SPDX-License-Identifier: Apache-2.0
// How much memory the program takes for rasters of different sizes.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "made_dem.hpp"
#include "program.hpp"

namespace waymark::test {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kOwnMemory = false;  // a sanitizer keeps what was freed
#else
constexpr bool kOwnMemory = true;
#endif

/// The largest memory of a run, MB.
double peak_of(const std::vector<std::string>& words) {
  return static_cast<double>(usage_of_waymark(words).ru_maxrss) / 1024;
}

/// A mosaic of `times` x `times` copies of a raster of 2000 x 2000 cells with a cone 15 m high every `apart`
/// cells: few trees, or many summits.
std::string mosaic(const TempFolder& folder, int times, int apart = 100) {
  const std::string one = folder / ("one" + std::to_string(apart) + ".tif");
  constexpr int kSide = 2000;
  if (!std::filesystem::exists(one)) {
    MadeDem chm{.columns = kSide, .rows = kSide, .geotransform = {500000, 0.5, 0, 5200000, 0, -0.5}};
    chm.height = [apart](int column, int row) {
      const int x = column % apart - apart / 2, y = row % apart - apart / 2;
      return std::max(0.0, 15 - 2 * std::hypot(x, y));
    };
    make_dem(one, chm);
  }
  std::string sources;
  for (int i = 0; i < times * times; ++i) {
    const auto attribute = [](const char* name, int value) {
      return std::string(" ") + name + "=\"" + std::to_string(value) + "\"";
    };
    const std::string size = attribute("xSize", kSide) + attribute("ySize", kSide);
    sources += "<SimpleSource><SourceFilename>" + one +
               "</SourceFilename><SourceBand>1</SourceBand><SrcRect" + attribute("xOff", 0) +
               attribute("yOff", 0) + size + "/><DstRect" + attribute("xOff", i % times * kSide) +
               attribute("yOff", i / times * kSide) + size + "/></SimpleSource>";
  }
  const std::string side = "\"" + std::to_string(times * kSide) + "\"",
                    file = folder / (std::to_string(times) + "_" + std::to_string(apart) + ".vrt");
  write_text(file, "<VRTDataset rasterXSize=" + side + " rasterYSize=" + side +
                       "><SRS>EPSG:32632</SRS><GeoTransform>500000,0.5,0,5200000,0,-0.5</GeoTransform>"
                       "<VRTRasterBand dataType=\"Float32\" band=\"1\">" +
                       sources + "</VRTRasterBand></VRTDataset>");
  return file;
}

// 128 MB more of raster and 9600 more trees.
TEST(Memory, OfTreesDoesNotGrowWithTheRaster) {
  if (!kOwnMemory) GTEST_SKIP() << "a sanitizer keeps what was freed";
  TempFolder folder;
  const auto peak = [&](int times) {
    return peak_of({"-q", "trees", "--chm", mosaic(folder, times), "--memory", "32", "--threads", "1",
                    "--tile-cells", "1000", "-o", folder / "trees.gpkg"});
  };
  const double small = peak(2), large = peak(4);
  EXPECT_GT(small, 20) << "MB";
  EXPECT_LT(large, small + 30) << "MB; " << small << " for a quarter of the raster";
}

// 375,000 observations more: in memory they would take 450 MB.
TEST(Memory, OfFlightsDoesNotGrowWithTheirTrees) {
  if (!kOwnMemory) GTEST_SKIP() << "a sanitizer keeps what was freed";
  TempFolder folder;
  const auto peak = [&](int times) {
    const std::string first = mosaic(folder, times, 8), second = folder / "later.vrt";
    std::filesystem::copy_file(first, second, std::filesystem::copy_options::overwrite_existing);
    return peak_of({"-q", "trees", "--chm", first, second, "--flights", "--memory", "32", "--threads", "1",
                    "--tile-cells", "1000", "-o", folder / "trees.gpkg"});
  };
  const double small = peak(1), large = peak(2);
  EXPECT_GT(small, 20) << "MB";
  EXPECT_LT(large, small + 100) << "MB; " << small << " for a quarter of the surveys";
}

// 84 M cells more: their tiles' borders and saddles would take 80 MB if all were held to the end.
TEST(Memory, OfPeaksGrowsSlowerThanItsTiles) {
  if (!kOwnMemory) GTEST_SKIP() << "a sanitizer keeps what was freed";
  TempFolder folder;
  const auto peak = [&](int times) {
    return peak_of({"-q", "peaks", mosaic(folder, times), "--memory", "32", "--threads", "1", "-o",
                    folder / "peaks.gpkg"});
  };
  const double small = peak(2), large = peak(5);
  EXPECT_GT(small, 20) << "MB";
  EXPECT_LT(large, small + 60) << "MB; " << small << " for a sixth of the raster";
}

// 250,000 summits as landmarks would take 250 MB.
TEST(Memory, OfPeaksHoldsSummitsInPieces) {
  if (!kOwnMemory) GTEST_SKIP() << "a sanitizer keeps what was freed";
  TempFolder folder;
  const auto peak = [&](const char* prominence) {
    return peak_of({"-q", "peaks", mosaic(folder, 2, 8), "--min-prominence", prominence, "--memory", "32",
                    "--threads", "1", "-o", folder / "peaks.gpkg"});
  };
  EXPECT_LT(peak("5"), peak("100") + 200) << "MB";
}

// Each call of a plan is a process of its own. The one that joins all tiles may hold their borders and
// summits, not their cells: 84 M cells more are 336 MB.
TEST(Memory, OfTheCallThatJoinsTilesIsNotThatOfTheirCells) {
  if (!kOwnMemory) GTEST_SKIP() << "a sanitizer keeps what was freed";
  TempFolder folder;
  const auto peaks = [&](int times) {
    const std::string name = std::to_string(times), job = folder / (name + ".json"),
                      work = folder / ("work" + name);
    write_text(job, waymark({"peaks", mosaic(folder, times), "--tile-cells", "1000", "--memory", "32",
                             "--print-job"})
                        .out);
    std::map<std::string, double> peak;
    for (const char* stage : {"load_dem", "find_mountain_tops", "join_mountain_tops", "measure_isolation",
                              "mountain_tops_of_tile"})
      peak[stage] = peak_of({"-q", "--threads", "1", "run", job, "--work", work, "--stage", stage});
    peak["map"] =
        peak_of({"-q", "--threads", "1", "run", job, "--work", work, "-o", folder / (name + ".gpkg")});
    return peak;
  };
  std::map<std::string, double> small = peaks(2), large = peaks(5);
  for (const auto& [call, megabytes] : large) {
    RecordProperty(call, std::to_string(small[call]) + " " + std::to_string(megabytes));
    EXPECT_GT(small[call], 20) << "MB, " << call;
    EXPECT_LT(megabytes, small[call] + 60)
        << "MB, " << call << "; " << small[call] << " for a sixth of the cells";
  }
}

/// A table of rocks, 100 to a row.
std::string rock_table(const TempFolder& folder, int count) {
  std::string text = "x,y,radius,height\n";
  for (int i = 0; i < count; ++i)
    text += std::to_string(i % 100 * 7) + "," + std::to_string(i / 100 * 7) + "," +
            std::to_string(0.2 + i % 50 * 0.05) + "," + std::to_string(0.3 + i % 40 * 0.02) + "\n";
  const std::string file = folder / (std::to_string(count) + ".csv");
  write_text(file, text);
  return file;
}

// As landmarks in memory, 100,000 rocks would take 130 to 220 MB.
TEST(Memory, OfMapsDoesNotGrowWithTheirLandmarks) {
  if (!kOwnMemory) GTEST_SKIP() << "a sanitizer keeps what was freed";
  TempFolder folder;
  const auto peaks = [&](int count) {
    const std::string map = folder / (std::to_string(count) + ".gpkg");
    std::map<std::string, double> peak;
    peak["import"] = peak_of(
        {"-q", "import", rock_table(folder, count), "-o", map, "--type", "rock", "--map-crs", "EPSG:32632"});
    peak["export to a map"] = peak_of({"-q", "export", map, folder / "out.gpkg", "--overwrite"});
    peak["export to FlatGeobuf"] = peak_of({"-q", "export", map, folder / "out.fgb", "--overwrite"});
    // GDAL's reader of KML would hold 1.8 kB a landmark.
    peak["export to KML"] = peak_of({"-q", "export", map, folder / "out.kml", "--overwrite"});
    peak["report"] = peak_of({"-q", "report", map, "-o", folder / "out.html"});
    return peak;
  };
  const auto small = peaks(20'000), large = peaks(120'000);
  for (const auto& [what, megabytes] : small) {
    RecordProperty(what, static_cast<int>(megabytes));
    EXPECT_GT(megabytes, 20) << "MB, " << what;
    // GDAL's index of FlatGeobuf holds about 270 bytes a landmark.
    const double more = what == "export to FlatGeobuf" ? 40 : 20;
    EXPECT_LT(large.at(what), megabytes + more) << "MB, " << what << ": " << megabytes << " for a sixth";
  }
}

// Most of the memory is that of GDAL and other libraries, which a query of one landmark loads, too.
TEST(Memory, OfAnImportIsLittleMoreThanItsLibraries) {
  if (!kOwnMemory) GTEST_SKIP() << "a sanitizer keeps what was freed";
  TempFolder folder;
  const std::string map = folder / "map.gpkg";
  const double import = peak_of(
      {"-q", "import", rock_table(folder, 300'000), "-o", map, "--type", "rock", "--map-crs", "EPSG:32632"});
  const double query = peak_of({"-q", "query", map, "--limit", "1"});
  RecordProperty("megabytes", std::to_string(import) + " " + std::to_string(query));
  EXPECT_GT(query, 20) << "MB";
  EXPECT_LT(import, query + 27) << "MB; " << query << " for a query";
}

}  // namespace
}  // namespace waymark::test
