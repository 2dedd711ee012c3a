// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "made_dem.hpp"
#include "program.hpp"

namespace waymark::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class BadInput : public testing::Test {
 protected:
  Outcome peaks(const std::vector<std::string>& words) {
    std::vector<std::string> all{"peaks", "-o", map()};
    all.insert(all.end(), words.begin(), words.end());
    return waymark(all);
  }
  /// The message of a DEM that is refused: exit code 1, no map, and the file is named.
  std::string refusal(const std::string& dem, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{dem};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome said = peaks(words);
    EXPECT_EQ(said.code, 1) << said.err;
    EXPECT_FALSE(std::filesystem::exists(map()));
    EXPECT_THAT(said.err, AllOf(StartsWith("error: "), HasSubstr(dem)));
    return said.err;
  }
  std::string made(const MadeDem& dem, const std::string& name = "dem.tif") {
    return make_dem(folder_ / name, dem);
  }
  std::string map() { return folder_ / "map.gpkg"; }

  TempFolder folder_;
};

TEST_F(BadInput, MissingFile) {
  EXPECT_THAT(refusal(folder_ / "no.tif"), HasSubstr("there is no such file"));
}

TEST_F(BadInput, EmptyFile) {
  write_text(folder_ / "dem.tif", "");
  EXPECT_THAT(refusal(folder_ / "dem.tif"), HasSubstr("empty"));
}

TEST_F(BadInput, TruncatedFile) {
  const std::string dem = made(hills(300, 300));
  std::filesystem::resize_file(dem, 200'000);
  EXPECT_THAT(refusal(dem), HasSubstr("truncated or damaged"));
}

TEST_F(BadInput, GdalSaysNothingBesideOurMessage) {
  const std::string dem = made(hills(300, 300));
  std::filesystem::resize_file(dem, 200'000);
  write_text(dem + ".aux.xml", "<PAMDataset><no end");
  const std::string said = peaks({dem}).err;
  EXPECT_THAT(said, HasSubstr("error: "));
  for (const char* gdal : {"ERROR ", "Warning ", "proj_"}) EXPECT_THAT(said, testing::Not(HasSubstr(gdal)));
  EXPECT_LT(std::ranges::count(said, '\n'), 8) << said;
}

TEST_F(BadInput, DamagedInTheMiddleOtherTilesGoOn) {
  MadeDem dem = hills(1300, 1300);
  dem.compressed_blocks = true;
  const std::string file = made(dem);
  damage(file, 0.75);
  const Outcome said = peaks({file, "--tile-cells", "256"});
  EXPECT_EQ(said.code, 3) << said.err;
  EXPECT_THAT(said.err, AllOf(HasSubstr("find_mountain_tops/tile_"), HasSubstr("truncated or damaged"),
                              HasSubstr("map.gpkg is not written")));
  EXPECT_FALSE(std::filesystem::exists(map()));
}

TEST_F(BadInput, NotARaster) {
  write_text(folder_ / "dem.tif", "Dear diary, today I climbed a hill.\n");
  EXPECT_THAT(refusal(folder_ / "dem.tif"), HasSubstr("not a raster"));
}

TEST_F(BadInput, ThreeBands) {
  MadeDem dem = twin_peaks();
  dem.bands = 3;
  EXPECT_THAT(refusal(made(dem)), HasSubstr("has 3"));
}

TEST_F(BadInput, ComplexCells) {
  MadeDem dem = twin_peaks();
  dem.cell_type = GDT_CFloat32;
  EXPECT_THAT(refusal(made(dem)), HasSubstr("complex"));
}

TEST_F(BadInput, NoCrs) {
  MadeDem dem = twin_peaks();
  dem.crs = "";
  EXPECT_THAT(refusal(made(dem)), HasSubstr("--crs"));
  EXPECT_EQ(peaks({folder_ / "dem.tif", "--crs", "local"}).code, 0);
}

TEST_F(BadInput, UnknownCrs) {
  EXPECT_THAT(peaks({made(twin_peaks()), "--crs", "EPSG:0"}).err, HasSubstr("EPSG:0"));
}

TEST_F(BadInput, Rotated) {
  MadeDem dem = twin_peaks();
  dem.geotransform[2] = 100;
  EXPECT_THAT(refusal(made(dem)), AllOf(HasSubstr("rotated"), HasSubstr("gdalwarp")));
}

TEST_F(BadInput, NoCellHasAHeight) {
  MadeDem dem = twin_peaks();
  dem.height = [](int, int) { return -9999.0; };
  EXPECT_THAT(refusal(made(dem)), HasSubstr("no heights"));
}

TEST_F(BadInput, DegreesThatSayTheyAreMetres) {
  MadeDem dem = twin_peaks();
  dem.geotransform = {8, 0.001, 0, 46, 0, -0.001};
  EXPECT_THAT(refusal(made(dem)), HasSubstr("degrees"));
}

TEST_F(BadInput, OverlappingTilesOfDifferentResolution) {
  MadeDem coarse = twin_peaks();
  coarse.geotransform[1] = 2000;
  const std::string fine = made(twin_peaks()), other = made(coarse, "coarse.tif");
  EXPECT_THAT(refusal(fine, {other}), AllOf(HasSubstr(other), HasSubstr("gdalwarp")));
}

TEST_F(BadInput, ConstantDemIsAWarning) {
  MadeDem dem;
  dem.height = [](int, int) { return 42.0; };
  const Outcome said = peaks({made(dem)});
  EXPECT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.err, HasSubstr("42"));
}

TEST_F(BadInput, OneCellIsASummit) {
  MadeDem dem;
  dem.columns = dem.rows = 1;
  dem.height = [](int, int) { return 42.0; };
  EXPECT_EQ(peaks({made(dem)}).code, 0);
  EXPECT_THAT(waymark({"query", map(), "--format", "csv"}).out, HasSubstr(",42,"));
}

TEST_F(BadInput, NanAndInfinityHaveNoHeight) {
  MadeDem dem = twin_peaks();
  dem.height = [ridge = dem.height](int column, int row) {
    if (column == 0 && row == 0) return std::nan("");
    if (column == 6 && row == 2) return std::numeric_limits<double>::infinity();
    return ridge(column, row);
  };
  EXPECT_EQ(peaks({made(dem)}).code, 0);
  EXPECT_THAT(waymark({"query", map(), "--format", "csv"}).out,
              AllOf(HasSubstr(",900,"), Not(HasSubstr("inf"))));
}

TEST_F(BadInput, ForeignGeoPackageIsRefused) {
  write_text(folder_ / "other.gpkg", "SQLite format 3");
  const Outcome said = waymark({"query", folder_ / "other.gpkg"});
  EXPECT_EQ(said.code, 1);
  EXPECT_THAT(said.err, AllOf(StartsWith("error: "), HasSubstr("other.gpkg")));
}

class BadJob : public BadInput {
 protected:
  Outcome run(const std::string& job, const std::vector<std::string>& more = {}) {
    write_text(folder_ / "job.json", job);
    std::vector<std::string> words{"run", folder_ / "job.json", "-o", map()};
    words.insert(words.end(), more.begin(), more.end());
    return waymark(words);
  }
};

TEST_F(BadJob, NotJsonNamesLineAndColumn) {
  const Outcome said = run("{\"stages\": [\n  {\"stage\": }\n]}");
  EXPECT_EQ(said.code, 2);
  EXPECT_THAT(said.err, HasSubstr("job.json:2:13\n"));
}

TEST_F(BadJob, WrongTypeNamesThePlace) {
  const Outcome said = run(R"({"stages": [{"stage": "load_dem", "files": ["a.tif"]},
                                          {"stage": "find_mountain_tops", "min_prominence": "high"}]})");
  EXPECT_EQ(said.code, 2);
  EXPECT_THAT(said.err, HasSubstr("stages[1].min_prominence must be a number, is a string (\"high\")"));
}

TEST_F(BadJob, UnknownOptionNamesTheNearest) {
  const Outcome said = run(R"({"stages": [{"stage": "find_mountain_tops", "min_prominense": 5}]})");
  EXPECT_EQ(said.code, 2);
  EXPECT_THAT(said.err,
              AllOf(HasSubstr("stages[0]"), HasSubstr("min_prominense"), HasSubstr("'min_prominence'")));
}

TEST_F(BadJob, UnknownStageNamesTheNearest) {
  const Outcome said = run(R"({"stages": [{"stage": "load_den"}]})");
  EXPECT_EQ(said.code, 2);
  EXPECT_THAT(said.err, AllOf(HasSubstr("load_den"), HasSubstr("load_dem")));
}

TEST_F(BadJob, StagesThatDoNotMeet) {
  const Outcome said = run(R"({"stages": [{"stage": "map_mountain_tops"}]})");
  EXPECT_EQ(said.code, 2);
  EXPECT_THAT(said.err, HasSubstr("dem"));
}

TEST_F(BadJob, SharesNeedAWorkFolder) {
  const std::string job = waymark({"peaks", made(twin_peaks()), "--print-job"}).out;
  EXPECT_THAT(run(job, {"--shard", "1/2"}).err, HasSubstr("needs --work"));
  EXPECT_THAT(run(job, {"--shard", "3/2"}).err, HasSubstr("--shard must be I/N with 1 <= I <= N, is '3/2'"));
}

}  // namespace
}  // namespace waymark::test
