// SPDX-License-Identifier: Apache-2.0
// Trees in colour images, and learning them.
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tests/apps/made_dem.hpp"
#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr int kTrees = 60;

struct Place {
  double x, y;
};

/// Places that stand at least 12 m apart, in rows that are not straight.
Place place(int tree) {
  const int column = tree % 10, row = tree / 10;
  return {30.0 + 24 * column + 5 * std::sin(tree * 2.3), 30.0 + 24 * row + 5 * std::cos(tree * 1.7)};
}

/// Dark crowns of 2.4 m on a lawn with grey squares, pixels of 0.6 m; the fourth band is near infrared.
MadeDem park(int bands) {
  MadeDem image{.columns = 290, .rows = 190, .geotransform = {500000, 0.6, 0, 4200000, 0, -0.6}};
  image.bands = bands;
  image.cell_type = GDT_Byte;
  image.nodata = 0;
  image.crs = "EPSG:26910";
  auto calls = std::make_shared<int>(0);
  image.height = [calls](int column, int row) {
    const int band = (*calls)++ / (290 * 190);
    constexpr std::array lawn{115, 140, 102, 178}, roof{150, 150, 150, 128}, crown{46, 69, 51, 153};
    const double noise = 3 * std::sin(column * 1.3 + row * 2.9 + band) * std::cos(column * 0.7 - row * 1.9);
    bool in_crown = false;
    for (int t = 0; t < kTrees; ++t)
      in_crown = in_crown || std::hypot(place(t).x - column, place(t).y - row) < 4;
    const auto& colour = in_crown ? crown : (column / 40 + row / 40) % 3 == 0 ? roof : lawn;
    return std::round(colour.at(static_cast<std::size_t>(band)) + noise);
  };
  return image;
}

std::string places() {
  std::string text = "x,y\n";
  for (int t = 0; t < kTrees; ++t)
    text += std::to_string(place(t).x) + "," + std::to_string(place(t).y) + "\n";
  return text;
}

/// Finds may be 10 pixels off.
json score_of(const std::string& found, const std::string& truth) {
  const Outcome reported = waymark({"evaluate", "landmarks", found, "--truth", truth, "--tolerance", "0",
                                    "--min-tolerance", "10", "--format", "json"});
  if (reported.code != 0) throw std::runtime_error(reported.err);
  return json::parse(reported.out)["landmarks"];
}

class ImageryTrees : public testing::Test {
 protected:
  Outcome detect(const std::string& image, const std::string& out,
                 const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"detect", "trees", folder_ / image, "-o", folder_ / out};
    words.insert(words.end(), more.begin(), more.end());
    return waymark(words);
  }
  json score(const std::string& found) {
    write_text(folder_ / "truth.csv", places());
    return score_of(folder_ / found, folder_ / "truth.csv");
  }
  TempFolder folder_;
};

TEST_F(ImageryTrees, AreFoundWithAndWithoutInfrared) {
  for (const int bands : {3, 4}) {
    make_dem(folder_ / "park.tif", park(bands));
    const Outcome made = detect("park.tif", "trees.csv");
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_GT(score("trees.csv")["f1"], 0.9) << bands << " bands";
  }
}

TEST_F(ImageryTrees, SearchesTellTheirProgress) {
  make_dem(folder_ / "park.tif", park(4));
  const Outcome made = detect("park.tif", "trees.csv", {"--progress", "dots"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, AllOf(HasSubstr("search_image: 0...10"), HasSubstr("100 - done.\n")));
}

TEST_F(ImageryTrees, TransparencyIsNoInfrared) {
  make_dem(folder_ / "park.tif", park(3));
  ASSERT_EQ(
      bash("gdalwarp -q -dstalpha '" + (folder_ / "park.tif") + "' '" + (folder_ / "alpha.tif") + "'").code,
      0);
  ASSERT_EQ(detect("park.tif", "plain.csv").code, 0);
  ASSERT_EQ(detect("alpha.tif", "alpha.csv").code, 0);
  EXPECT_EQ(text_of(folder_ / "alpha.csv"), text_of(folder_ / "plain.csv"));
}

TEST_F(ImageryTrees, SixteenBitsAreRarelyUsedWhole) {
  MadeDem deep = park(4);
  const auto grey = deep.height;
  deep.cell_type = GDT_UInt16;
  deep.height = [grey](int column, int row) { return 12 * grey(column, row); };
  make_dem(folder_ / "deep.tif", deep);
  ASSERT_EQ(detect("deep.tif", "trees.csv").code, 0);
  EXPECT_GT(score("trees.csv")["f1"], 0.9);
}

TEST_F(ImageryTrees, OddImagesAreNoTrouble) {
  MadeDem tiny = park(4);
  tiny.columns = tiny.rows = 1;
  make_dem(folder_ / "tiny.tif", tiny);
  EXPECT_EQ(detect("tiny.tif", "tiny.csv").code, 0);
  for (const double grey : {0.0, 1.0, 255.0}) {  // 0 is no data
    MadeDem flat = park(4);
    flat.height = [grey](int, int) { return grey; };
    make_dem(folder_ / "flat.tif", flat);
    const Outcome made = detect("flat.tif", "flat.csv");
    EXPECT_EQ(made.code, 0) << made.err;
    EXPECT_EQ(text_of(folder_ / "flat.csv").find("nan"), std::string::npos);
  }
}

TEST_F(ImageryTrees, AreTheSameForAnyThreads) {
  MadeDem wide = park(4);
  make_dem(folder_ / "park.tif", wide);
  // Wider than one piece of work, so that crowns lie on its seams.
  ASSERT_EQ(
      bash("gdal_translate -q -outsize 1740 1140 -r nearest '" + (folder_ / "park.tif") + "' '" +
           (folder_ / "wide.tif") + "' && gdal_edit.py -a_ullr 0 684 1044 0 '" + (folder_ / "wide.tif") + "'")
          .code,
      0);
  ASSERT_EQ(detect("wide.tif", "one.csv", {"--threads", "1"}).code, 0);
  ASSERT_EQ(detect("wide.tif", "two.csv", {"--threads", "2"}).code, 0);
  EXPECT_EQ(text_of(folder_ / "one.csv"), text_of(folder_ / "two.csv"));
}

TEST_F(ImageryTrees, AreLearntFromMarkedImages) {
  for (const char* name : {"a", "b", "c"}) {
    make_dem(folder_ / (std::string(name) + ".tif"), park(4));
    write_text(folder_ / (std::string(name) + ".csv"), places());
  }
  write_text(folder_ / "c.csv", "x,y\n");  // an image without a tree is a lesson, too
  const Outcome made = waymark({"train", "trees", folder_ / "a.tif", folder_ / "b.tif", folder_ / "c.tif",
                                "-o", folder_ / "model.txt", "--rounds", "1", "--progress", "dots"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, HasSubstr("train trees: 0...10...20"));
  EXPECT_THAT(made.err, HasSubstr("100 - done.\n"));
  EXPECT_THAT(made.out + made.err, HasSubstr("3 images, 120 trees, 1 rounds, seed 1; left out in turn"));
  EXPECT_THAT(text_of(folder_ / "model.txt"), testing::StartsWith("waymark network 2 crowns\n3 images"));
  ASSERT_EQ(waymark({"train", "trees", folder_ / "a.tif", "-o", folder_ / "model.cpp", "--rounds", "1"}).code,
            0);
  EXPECT_THAT(text_of(folder_ / "model.cpp"),
              HasSubstr("\nnamespace waymark::pipeline {\n\nconst DenseNetwork& crown_network_infrared()"));
}

TEST_F(ImageryTrees, WrongUseOfLearningIsExplained) {
  const auto train = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"train"});
    words.insert(words.end(), {"-o", folder_ / "model.txt"});
    return waymark(words);
  };
  EXPECT_THAT(train({"trees", "--colour"}).err, HasSubstr("--colour and --rounds are for trees in images"));
  EXPECT_THAT(train({"rocks", "a.tif"}).err, HasSubstr("rocks are trained on made scenes, not on images"));
  EXPECT_THAT(train({"craters", "a.tif"}).err, HasSubstr("not on images"));
  make_dem(folder_ / "park.tif", park(3));
  EXPECT_THAT(train({"trees", folder_ / "park.tif"}).err, HasSubstr("no fourth band"));
  EXPECT_THAT(train({"trees", "--colour", folder_ / "park.tif"}).err, HasSubstr("park.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "model.txt"));
}

// What the shipped networks learnt, so no figure of quality (docs/evaluation/2026-11-21-trees-in-real-data.md
// has those of images left out): it shows whether the program still finds what it found.
TEST(RealImageryTrees, EurekaIsAsItWas) {
  const std::filesystem::path eureka =
      std::filesystem::path(WAYMARK_SOURCE_DIR) / "../shared/data/forest/eureka";
  if (!std::filesystem::exists(eureka)) GTEST_SKIP() << eureka << " is not on this machine";
  TempFolder folder;
  double matched = 0, found = 0, truth = 0;
  for (int i = 0; i < 21; ++i) {
    const std::string name = (eureka / ("eureka_2020_" + std::to_string(i))).string();
    const std::string marked = text_of(name + ".csv");
    if (marked.find('\n') == std::string::npos || marked.find_first_of("0123456789") == std::string::npos)
      continue;
    ASSERT_EQ(waymark({"detect", "trees", name + ".tif", "-o", folder / "trees.csv", "-q"}).code, 0);
    const json reported = score_of(folder / "trees.csv", name + ".csv");
    matched += reported["matched"].get<double>();
    found += reported["found"].get<double>();
    truth += reported["truth"].get<double>();
  }
  ASSERT_GT(truth, 1500);
  EXPECT_GT(2 * matched / (found + truth), 0.68);
}

}  // namespace
}  // namespace waymark::test
