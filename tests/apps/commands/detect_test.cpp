// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

constexpr double kDegree = std::numbers::pi / 180;

struct Bowl {
  double x, y, radius;
};

/// Ground of 300 x 200 pixels with faint texture and parabolic bowls, lit from `sun` degrees (from right
/// towards down) at 35 degrees above it, as a PGM.
std::string make_bowls(const std::string& file, const std::vector<Bowl>& bowls, double sun, int columns = 300,
                       int rows = 200) {
  std::string pixels;
  std::uint32_t state = 12345;
  const double lx = std::cos(sun * kDegree) / std::tan(35 * kDegree),
               ly = std::sin(sun * kDegree) / std::tan(35 * kDegree);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      double slope_x = 0, slope_y = 0;
      for (const Bowl& bowl : bowls) {
        const double dx = column - bowl.x, dy = row - bowl.y, r = std::hypot(dx, dy) / bowl.radius;
        // depth / diameter 0.2 inside, a rim that falls off outside
        const double slope = r < 1 ? 0.8 * r : r < 1.6 ? -0.25 * (1.6 - r) / 0.6 : 0;
        if (r > 0 && r < 1.6)
          slope_x += slope * dx / (r * bowl.radius), slope_y += slope * dy / (r * bowl.radius);
      }
      state = state * 1664525u + 1013904223u;
      const double noise = static_cast<double>(state >> 24) / 255 - 0.5;
      const double shade = 1 - (slope_x * lx + slope_y * ly) * 0.7;
      pixels +=
          static_cast<char>(static_cast<unsigned char>(std::clamp(100 * shade + 4 * noise, 1.0, 254.0)));
    }
  std::ofstream(file, std::ios::binary) << "P5 " << columns << ' ' << rows << " 255\n" << pixels;
  return file;
}

/// A cell of a CSV by line (from 1) and column name.
double cell(const std::string& csv, int line, const std::string& name) {
  std::istringstream lines(csv);
  std::string header, text;
  std::getline(lines, header);
  for (int i = 0; i < line; ++i) std::getline(lines, text);
  std::istringstream names(header), cells(text);
  for (std::string key, value; std::getline(names, key, ',');) {
    std::getline(cells, value, ',');
    if (key == name) return value.empty() ? std::nan("") : std::stod(value);
  }
  ADD_FAILURE() << "no column " << name << " in " << header;
  return std::nan("");
}

class Detect : public testing::Test {
 protected:
  const std::vector<Bowl> bowls_ = {
      {60, 60, 20}, {160, 120, 30}, {250, 60, 15}, {240, 150, 18}, {60, 150, 25}};

  Outcome detect(const std::string& image, std::vector<std::string> words,
                 const std::string& kind = "craters") {
    words.insert(words.begin(), {"detect", kind, image});
    return waymark(words);
  }
  std::string geo(const std::string& image, const std::string& crs, const std::string& corners) {
    const std::string out = folder_ / "geo.tif";
    EXPECT_EQ(
        bash("gdal_translate -q -a_srs '" + crs + "' -a_ullr " + corners + " " + image + " " + out).code, 0);
    return out;
  }

  TempFolder folder_;
  std::string image_ = make_bowls(folder_ / "bowls.pgm", bowls_, 200);
  std::string csv_ = folder_ / "out.csv";
};

TEST_F(Detect, CsvHasPixelsAndNothingElseWithoutAScale) {
  const Outcome said = detect(image_, {"-o", csv_, "--image-sun-angle", "200"});
  ASSERT_EQ(said.code, 0) << said.err;
  const std::string csv = text_of(csv_);
  EXPECT_THAT(csv, StartsWith("x,y,diameter,major,minor,angle,confidence\n"));
  for (const Bowl& bowl : bowls_) {
    bool found = false;
    for (int line = 1; line <= std::ranges::count(csv, '\n') - 1; ++line)
      found = found ||
              (std::hypot(cell(csv, line, "x") - bowl.x, cell(csv, line, "y") - bowl.y) < 0.3 * bowl.radius &&
               std::abs(cell(csv, line, "diameter") / (2 * bowl.radius) - 1) < 0.3);
    EXPECT_TRUE(found) << "bowl at " << bowl.x << ", " << bowl.y;
  }
  EXPECT_NEAR(cell(csv, 1, "diameter"), std::sqrt(cell(csv, 1, "major") * cell(csv, 1, "minor")), 1e-3);
  EXPECT_LE(std::abs(cell(csv, 1, "angle")), 90);
}

TEST_F(Detect, GsdGivesMetres) {
  ASSERT_EQ(detect(image_, {"-o", csv_, "--image-sun-angle", "200", "--gsd", "0.5"}).code, 0);
  const std::string csv = text_of(csv_);
  EXPECT_THAT(
      csv, StartsWith(
               "x,y,diameter,major,minor,angle,confidence,radius,depth,major_axis,minor_axis,orientation\n"));
  EXPECT_NEAR(cell(csv, 1, "radius"), cell(csv, 1, "diameter") / 4, 1e-3);
  EXPECT_NEAR(cell(csv, 1, "major_axis"), cell(csv, 1, "major") / 2, 1e-3);
  EXPECT_TRUE(std::isnan(cell(csv, 1, "depth")));  // one image does not tell
}

TEST_F(Detect, OrthophotoGivesMapUnits) {
  const std::string ortho = geo(image_, "EPSG:32632", "500000 5200000 500600 5199600");  // 2 m pixels
  // towards the sun 200 degrees from right to down is azimuth 290: the west-north-west
  ASSERT_EQ(detect(ortho, {"-o", csv_, "--sun-azimuth", "290"}).code, 0);
  const std::string csv = text_of(csv_);
  EXPECT_NEAR(cell(csv, 1, "map_x"), 500001 + 2 * cell(csv, 1, "x"), 1e-3);
  EXPECT_NEAR(cell(csv, 1, "map_y"), 5199999 - 2 * cell(csv, 1, "y"), 1e-3);
  EXPECT_NEAR(cell(csv, 1, "radius"), cell(csv, 1, "diameter"), 1e-2);
  ASSERT_EQ(detect(image_, {"-o", folder_ / "plain.csv", "--image-sun-angle", "200"}).code, 0);
  EXPECT_EQ(cell(csv, 1, "x"), cell(text_of(folder_ / "plain.csv"), 1, "x"));  // the same sun
}

TEST_F(Detect, GeoJsonAndGeoPackage) {
  const std::string ortho = geo(image_, "EPSG:32632", "500000 5200000 500600 5199600");
  const std::string out = folder_ / "out.geojson", map = folder_ / "out.gpkg";
  ASSERT_EQ(detect(ortho, {"-o", out, "--sun-azimuth", "290"}).code, 0);
  const json collection = json::parse(text_of(out));
  EXPECT_FALSE(collection.contains("crs"));  // RFC 7946: longitude and latitude
  ASSERT_FALSE(collection["features"].empty());
  const json& first = collection["features"][0];
  EXPECT_NEAR(first["geometry"]["coordinates"][0], 9, 0.01);
  EXPECT_NEAR(first["geometry"]["coordinates"][1], 46.95, 0.02);
  EXPECT_EQ(first["properties"]["type"], "crater");
  ASSERT_EQ(detect(ortho, {"-o", map, "--sun-azimuth", "290"}).code, 0);
  EXPECT_EQ(waymark({"validate", map}).code, 0) << waymark({"validate", map}).err;
  EXPECT_EQ(json::parse(waymark({"query", map, "--format", "json"}).out).size(),
            collection["features"].size());
  ASSERT_EQ(detect(image_, {"-o", map, "--image-sun-angle", "200"}).code,
            0);  // replaced; a pixel counts as 1 m
  EXPECT_EQ(waymark({"validate", map}).code, 0);
}

TEST_F(Detect, OtherBodiesAndPixelsNameTheirCrs) {
  const std::string out = folder_ / "out.geojson";
  const std::string mars =
      geo(image_, "+proj=eqc +lat_ts=0 +lon_0=0 +a=3396190 +b=3396190 +units=m +no_defs", "-60000 40000 0 0");
  ASSERT_EQ(detect(mars, {"-o", out, "--image-sun-angle", "200"}).code, 0);
  EXPECT_THAT(bash("ogrinfo -so -al " + out).out, AllOf(HasSubstr("3396190"), Not(HasSubstr("WGS"))));
  ASSERT_EQ(detect(image_, {"-o", out, "--image-sun-angle", "200"}).code, 0);
  EXPECT_THAT(bash("ogrinfo -so -al " + out).out, Not(HasSubstr("WGS")));
}

TEST_F(Detect, SunIsEstimatedAndChecked) {
  const Outcome estimated = detect(image_, {"-o", csv_});
  ASSERT_EQ(estimated.code, 0);
  EXPECT_THAT(estimated.err, HasSubstr("degrees in the image, by"));
  EXPECT_THAT(detect(image_, {"-o", csv_, "--image-sun-angle", "20"}).err,
              HasSubstr("the light is said to come from 20 degrees"));  // half a turn off: a classic
}

TEST_F(Detect, PiecesFindWhatTheWholeFinds) {
  std::vector<Bowl> many;
  for (int i = 0; i < 24; ++i)
    many.push_back({50.0 + 97 * (i % 6), 50.0 + 97 * std::floor(i / 6), 9.0 + i % 5});
  const std::string large = make_bowls(folder_ / "large.pgm", many, 200, 600, 400);
  const auto with = [&](const std::string& out, const std::string& piece, const std::string& threads) {
    EXPECT_EQ(detect(large, {"-o", folder_ / out, "--image-sun-angle", "200", "--min-diameter", "12",
                             "--max-diameter", "28", "--tile-pixels", piece, "--threads", threads})
                  .code,
              0);
    return text_of(folder_ / out);
  };
  const std::string whole = with("whole.csv", "1024", "1"), pieces = with("pieces.csv", "448", "1");
  EXPECT_EQ(with("threads.csv", "448", "2"), pieces);
  EXPECT_GE(std::ranges::count(whole, '\n'), 20);
  EXPECT_NEAR(static_cast<double>(std::ranges::count(pieces, '\n')),
              static_cast<double>(std::ranges::count(whole, '\n')), 1);
  const std::string reported = detect(large, {"-o", csv_, "--tile-pixels", "256", "--progress", "json"}).err;
  const std::string last = reported.substr(reported.rfind(R"({"stage":"search_image")"));
  const json end = json::parse(last.substr(0, last.find('\n')));
  EXPECT_GT(end["total"], 2);
  EXPECT_EQ(end["done"], end["total"]);
  EXPECT_GT(end["units_per_second"], 0);
}

TEST_F(Detect, CratersLargerThanAPieceAreFoundInTheImageReduced) {
  const std::string large = make_bowls(folder_ / "large.pgm", {{300, 200, 70}}, 200, 600, 400);
  ASSERT_EQ(detect(large, {"-o", csv_, "--image-sun-angle", "200", "--tile-pixels", "256"}).code, 0);
  const std::string csv = text_of(csv_);
  bool found = false;
  for (int line = 1; line < std::ranges::count(csv, '\n'); ++line)
    found = found || (std::hypot(cell(csv, line, "x") - 300, cell(csv, line, "y") - 200) < 15 &&
                      std::abs(cell(csv, line, "diameter") / 140 - 1) < 0.2);
  EXPECT_TRUE(found) << csv;
}

TEST_F(Detect, ImagesInWhichNothingCanBeSeen) {
  const auto flat = [&](const std::string& name, int side, int value) {
    const std::string file = folder_ / name;
    std::ofstream(file, std::ios::binary)
        << "P5 " << side << ' ' << side << " 255\n"
        << std::string(static_cast<std::size_t>(side * side), static_cast<char>(value));
    return file;
  };
  for (const std::string kind : {"craters", "rocks"}) {
    const auto says = [&](const std::string& image) {
      const Outcome said = detect(image, {"-o", csv_}, kind);
      EXPECT_EQ(said.code, 0) << said.err;
      EXPECT_EQ(text_of(csv_), "x,y,diameter,major,minor,angle,confidence\n");
      return said.err;
    };
    EXPECT_THAT(says(flat("one.pgm", 1, 7)), HasSubstr("the image measures 1 x 1 pixels"));
    EXPECT_THAT(says(flat("black.pgm", 100, 0)), HasSubstr("all pixels of the image are 0"));
    EXPECT_THAT(says(flat("white.pgm", 100, 255)), HasSubstr("all pixels of the image are 255"));
  }
}

TEST_F(Detect, DegreesAreSearchedInPixelsWithTheCureTold) {
  const std::string degrees = geo(image_, "EPSG:4326", "9 47 9.003 46.998");
  const Outcome said = detect(degrees, {"-o", csv_, "--image-sun-angle", "200"});
  EXPECT_EQ(said.code, 0);
  EXPECT_THAT(said.err, AllOf(HasSubstr("results are in pixels"), HasSubstr("gdalwarp")));
  EXPECT_THAT(text_of(csv_), Not(HasSubstr("map_x")));
}

TEST_F(Detect, WrongOptionsAreRefused) {
  const auto refused = [&](std::vector<std::string> words, const std::string& kind = "craters") {
    words.insert(words.end(), {"-o", csv_});
    const Outcome said = detect(image_, words, kind);
    EXPECT_EQ(said.code, 2) << said.err;
    EXPECT_FALSE(std::filesystem::exists(csv_));
    return said.err;
  };
  EXPECT_THAT(refused({}, "crators"), HasSubstr("did you mean 'craters'"));
  EXPECT_THAT(refused({"--method", "bowl"}, "trees"),
              HasSubstr("trees are found by imagery or peaks or lmf"));
  EXPECT_THAT(refused({"--method", "shadow"}),
              HasSubstr("craters are found by bowl or edges, not by 'shadow'"));
  EXPECT_THAT(refused({"--sun-azimuth", "90"}),
              AllOf(HasSubstr("no georeference"), HasSubstr("--image-sun-angle")));
  EXPECT_THAT(refused({"--sun-azimuth", "90", "--image-sun-angle", "0"}), HasSubstr("both say"));
  EXPECT_THAT(refused({"--sun-elevation", "-3"}, "rocks"), HasSubstr("the sun is not above the ground"));
  EXPECT_THAT(refused({"--sun-elevation", "95"}, "rocks"),
              HasSubstr("--sun-elevation = 95 is outside [0, 90] deg"));
  EXPECT_THAT(refused({"--gsd", "0"}), HasSubstr("a pixel measures more than nothing"));
  EXPECT_THAT(refused({"--min-diameter", "50", "--max-diameter", "20"}), HasSubstr("is not below"));
  EXPECT_THAT(refused({"--min-confidence", "2"}), HasSubstr("--min-confidence = 2 is outside [0, 1]"));
}

TEST_F(Detect, MissingFilesAndFolders) {
  EXPECT_THAT(detect(folder_ / "no.png", {"-o", csv_}).err, HasSubstr("there is no such file"));
  EXPECT_EQ(detect(folder_ / "no.png", {"-o", csv_}).code, 1);
  EXPECT_THAT(detect(image_, {"-o", folder_ / "no/out.csv"}).err, HasSubstr("mkdir -p"));
  const Outcome said = detect(image_, {"-o", folder_ / "out.txt"});
  EXPECT_EQ(said.code, 2);
  EXPECT_THAT(said.err, HasSubstr(".csv, .geojson or .gpkg"));
}

/// Nine rocks under a sun at the left (180 degrees), each a dark ellipse to the right of a bright spot, as a
/// PGM of 128 x 128 pixels. The lowest `shaded` rows lie in shadow.
std::string make_rocks(const std::string& file, int shaded = 0) {
  std::string pixels;
  std::uint32_t state = 99;
  for (int row = 0; row < 128; ++row)
    for (int column = 0; column < 128; ++column) {
      double value = 120;
      for (int i = 0; i < 9; ++i) {
        const double cx = 24 + 40 * (i % 3), cy = 24 + 40 * (i / 3);
        const double shadow = std::hypot((column - cx - 5) / 6, (row - cy) / 3),
                     body = std::hypot((column - cx + 1) / 3, (row - cy) / 3);
        if (shadow < 1) value = 25;
        if (body < 1 && column < cx + 1) value = 190;
      }
      if (row >= 128 - shaded) value = 25;
      state = state * 1664525u + 1013904223u;
      pixels += static_cast<char>(static_cast<unsigned char>(value + static_cast<double>(state >> 24) / 64));
    }
  std::ofstream(file, std::ios::binary) << "P5 128 128 255\n" << pixels;
  return file;
}

TEST_F(Detect, RocksOfAGivenSunHaveHeights) {
  const std::string rocks = make_rocks(folder_ / "rocks.pgm");
  const Outcome said = detect(
      rocks, {"-o", csv_, "--image-sun-angle", "180", "--sun-elevation", "30", "--gsd", "0.1"}, "rocks");
  ASSERT_EQ(said.code, 0) << said.err;
  const std::string csv = text_of(csv_);
  EXPECT_THAT(csv, StartsWith("x,y,diameter,major,minor,angle,confidence,radius,height\n"));
  ASSERT_GE(std::ranges::count(csv, '\n'), 5) << csv;
  EXPECT_GT(cell(csv, 1, "height"), 0.1);
  EXPECT_LT(cell(csv, 1, "height"), 1.5);
  EXPECT_THAT(detect(rocks, {"-o", csv_, "--image-sun-angle", "180", "--gsd", "0.1"}, "rocks").err,
              HasSubstr("rocks have no heights"));
  // The shadow lies along the rows: twice as high pixels do not make it longer.
  const std::string oblong = geo(rocks, "EPSG:32632", "500000 5200025.6 500012.8 5200000");
  ASSERT_EQ(detect(oblong, {"-o", csv_, "--image-sun-angle", "180", "--sun-elevation", "30"}, "rocks").code,
            0);
  EXPECT_EQ(cell(text_of(csv_), 1, "height"), cell(csv, 1, "height"));
  EXPECT_NEAR(cell(text_of(csv_), 1, "radius"), cell(csv, 1, "radius") * std::numbers::sqrt2, 1e-4);
}

TEST_F(Detect, GroundInShadowIsReported) {
  const auto says = [&](int shaded) {
    return detect(make_rocks(folder_ / "shaded.pgm", shaded), {"-o", csv_, "--image-sun-angle", "180"},
                  "rocks")
        .err;
  };
  EXPECT_THAT(says(0), Not(HasSubstr("lie in shadow")));
  EXPECT_THAT(says(32),
              HasSubstr("27 % of the pixels lie in shadow"));  // a quarter, and shadows of six rocks
}

TEST_F(Detect, GeoreferencesThatOptionsContradict) {
  const std::string plane = folder_ / "plane.tif";
  ASSERT_EQ(bash("gdal_translate -q -a_ullr 0 400 600 0 " + image_ + " " + plane).code, 0);
  const Outcome sized = detect(plane, {"-o", csv_, "--image-sun-angle", "200", "--gsd", "0.5"});
  EXPECT_EQ(sized.code, 0);
  EXPECT_THAT(sized.err, HasSubstr("--gsd 0.5 is not used: the image's georeference says 2 m per pixel"));
  const Outcome degrees =
      detect(geo(image_, "EPSG:4326", "9 47 9.003 46.998"), {"-o", csv_, "--sun-azimuth", "290"});
  EXPECT_EQ(degrees.code, 2);
  EXPECT_THAT(degrees.err, AllOf(HasSubstr("its georeference is not used"), HasSubstr("is in degrees"),
                                 HasSubstr("--image-sun-angle")));
}

TEST_F(Detect, VerifierTrainedOnMarkedImages) {
  std::vector<Bowl> many;
  std::string table = "x,y,diameter\n";
  for (int i = 0; i < 24; ++i) {
    const Bowl bowl{40.0 + 72 * (i % 6), 40.0 + 76 * (i / 6), 9.0 + (i * 7) % 13};
    many.push_back(bowl);
    if (i % 3 != 0)  // hollows that nobody marked are background
      table += fmt::format("{},{},{}\n", bowl.x, bowl.y, 2 * bowl.radius);
  }
  const std::string image = make_bowls(folder_ / "many.pgm", many, 200, 460, 340);
  const std::string marks = folder_ / "many.csv", verifier = folder_ / "verifier.txt";
  std::ofstream(marks) << table;
  const auto train = [&](const std::string& labels, const std::string& out) {
    return waymark({"train", "craters", "--labels", labels, "-o", out, "--scenes", "3", "--rounds", "2"});
  };
  const Outcome trained = train(image + "," + marks, verifier);
  ASSERT_EQ(trained.code, 0) << trained.err;
  EXPECT_THAT(trained.out + trained.err, HasSubstr("16 craters"));
  EXPECT_THAT(text_of(verifier), HasSubstr("3 views of each of 1 marked images"));
  // The same pixels with sixteen bits give the same direction of the light.
  const std::string deep = folder_ / "deep.tif";
  ASSERT_EQ(bash("gdal_translate -q -ot UInt16 -scale 0 255 0 65535 " + image + " " + deep).code, 0);
  EXPECT_EQ(train(deep + "," + marks, folder_ / "deep.txt").code, 0);

  ASSERT_EQ(detect(image, {"-o", csv_, "--image-sun-angle", "200", "--min-confidence", "0"}).code, 0);
  const std::string shipped = text_of(csv_);
  const Outcome own = detect(
      image, {"-o", csv_, "--image-sun-angle", "200", "--min-confidence", "0", "--verifier", verifier});
  ASSERT_EQ(own.code, 0) << own.err;
  EXPECT_NE(text_of(csv_), shipped);

  EXPECT_THAT(detect(image, {"-o", csv_, "--verifier", verifier}, "rocks").err,
              HasSubstr("--verifier is for craters that the method bowl finds"));
  EXPECT_EQ(detect(image, {"-o", csv_, "--verifier", marks}).code, 1);
  EXPECT_THAT(train(image, verifier).err, HasSubstr("names no table of craters"));
  std::ofstream(marks) << "x,y,diameter\n900,20,30\n";
  EXPECT_THAT(train(image + "," + marks, verifier).err, HasSubstr("lies outside the image of 460 x 340"));
}

}  // namespace
}  // namespace waymark::test
