// SPDX-License-Identifier: Apache-2.0
// `waymark reconstruct --control`: surveyed points through the program, good ones and bad ones.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "tests/apps/made_flight.hpp"
#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

/// Six images of 300 x 300 pixels in metres about (0, 0), without GPS.
const fs::path& surveyed_flight() {
  static const TempFolder folder;
  static const fs::path site = simulate_flight(folder.path(), {});
  return site;
}

using Xyz = std::array<double, 3>;

struct SurveyedPoint {
  std::string name = {};
  Xyz at = {};     // true
  Xyz given = {};  // in the file
};

std::vector<SurveyedPoint> surveyed_points() {
  std::vector<SurveyedPoint> points;
  const double offsets[][3] = {{-20, -15, 0}, {20, -15, 3}, {-20, 15, 2}, {20, 15, -1},
                               {0, 0, 4},     {8, -10, 0},  {-9, 8, 1}};
  for (const auto& o : offsets) {
    const Xyz at{o[0], o[1], o[2]};
    points.push_back({fmt::format("P{}", points.size() + 1), at, at});
  }
  points[5].name = "check_6";
  return points;
}

/// Calls use(image, column, row) where a true camera shows the point.
void for_marks(const Xyz& at, const std::function<void(std::string, double, double)>& use) {
  const json file = json::parse(text_of(surveyed_flight() / "truth/cameras.json"));
  const json& lens = file["cameras"]["lens"];
  for (const json& image : file["images"]) {
    Xyz in_camera{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t k = 0; k < 3; ++k)
        in_camera[axis] += double(image["rotation"][k][axis]) * (at[k] - double(image["centre"][k]));
    const double column = double(lens["fx"]) * in_camera[0] / in_camera[2] + double(lens["cx"]),
                 row = double(lens["fy"]) * in_camera[1] / in_camera[2] + double(lens["cy"]);
    if (in_camera[2] > 0 && column > 0 && row > 0 && column < 299 && row < 299)
      use(image["name"], column, row);
  }
}

std::string gcp_list(const std::vector<SurveyedPoint>& points, const std::string& crs = "local") {
  std::string text = crs + "\n";
  for (const SurveyedPoint& p : points)
    for_marks(p.at, [&](const std::string& image, double column, double row) {
      text += fmt::format("{:.3f} {:.3f} {:.3f} {:.3f} {:.3f} {} {}\n", p.given[0], p.given[1], p.given[2],
                          column, row, image, p.name);
    });
  return text;
}

class ReconstructWithControl : public testing::Test {
 protected:
  Outcome run(const std::string& list, std::vector<std::string> more = {}) {
    write_text(folder_ / "gcp_list.txt", list);
    std::vector<std::string> words{"reconstruct", (surveyed_flight() / "images").string(),
                                   "--lens",      (surveyed_flight() / "truth/cameras.json").string(),
                                   "--control",   folder_ / "gcp_list.txt",
                                   "--until",     "poses",
                                   "-o",          folder_ / "out"};
    words.insert(words.end(), more.begin(), more.end());
    return waymark(words);
  }
  TempFolder folder_;
};

TEST_F(ReconstructWithControl, PosesAreThoseOfTheMap) {
  const Outcome made = run(gcp_list(surveyed_points()));
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, HasSubstr("frame: local"));
  EXPECT_THAT(made.err, HasSubstr("6 of 6 control points: RMS "));
  EXPECT_THAT(made.err, HasSubstr("1 of 1 check points: RMS "));
  const json found = json::parse(text_of(folder_ / "out/cameras.json")),
             truth = json::parse(text_of(surveyed_flight() / "truth/cameras.json"));
  for (std::size_t i = 0; i < 6; ++i)
    for (int axis = 0; axis < 3; ++axis)  // a pixel is 0.35 m
      EXPECT_NEAR(double(found["images"][i]["centre"][axis]), double(truth["images"][i]["centre"][axis]),
                  0.35)
          << i << " " << axis;
}

TEST_F(ReconstructWithControl, ALayerAndATableOfMarksDoTheSame) {
  std::string points = "name,x,y,z,sd,check\n", marks = "point,image,column,row\n";
  for (const SurveyedPoint& p : surveyed_points()) {
    points +=
        fmt::format("{},{},{},{},0.02,{}\n", p.name, p.at[0], p.at[1], p.at[2], p.name == "P7" ? "yes" : "");
    for_marks(p.at, [&](const std::string& image, double column, double row) {
      marks += fmt::format("{},{},{:.3f},{:.3f}\n", p.name, image, column, row);
    });
  }
  write_text(folder_ / "points.csv", points);
  write_text(folder_ / "marks.csv", marks);
  const std::vector<std::string> words{"reconstruct", (surveyed_flight() / "images").string(),
                                       "--lens",      (surveyed_flight() / "truth/cameras.json").string(),
                                       "--control",   folder_ / "points.csv",
                                       "--until",     "poses",
                                       "-o",          folder_ / "out"};
  std::vector<std::string> all = words;
  all.insert(all.end(), {"--marks", folder_ / "marks.csv", "--crs", "local"});
  const Outcome made = waymark(all);
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, HasSubstr("5 of 5 control points"));
  EXPECT_THAT(made.err, HasSubstr("2 of 2 check points"));
  const Outcome without = waymark(words);
  EXPECT_EQ(without.code, 2);
  EXPECT_THAT(without.err, HasSubstr("the marks of the control points are not given"));
}

TEST_F(ReconstructWithControl, TwoPointsAreTooFew) {
  std::vector<SurveyedPoint> points = surveyed_points();
  points.resize(2);
  const Outcome made = run(gcp_list(points));
  EXPECT_EQ(made.code, 1);
  EXPECT_THAT(made.err, HasSubstr("2 control points and positions of cameras are known, and 3 are needed"));
}

TEST_F(ReconstructWithControl, ThreePointsInALineLeaveTheTurnOpen) {
  std::vector<SurveyedPoint> points = surveyed_points();
  points.resize(3);
  points[0].at = points[0].given = {-20, 0, 0};
  points[1].at = points[1].given = {0, 0, 0};
  points[2].at = points[2].given = {20, 0, 0};
  const Outcome made = run(gcp_list(points));
  EXPECT_EQ(made.code, 1);
  EXPECT_THAT(made.err, HasSubstr("of one line"));
}

TEST_F(ReconstructWithControl, SwappedNamesAreNamed) {
  std::vector<SurveyedPoint> points = surveyed_points();
  std::swap(points[0].given, points[3].given);
  const Outcome made = run(gcp_list(points));
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, HasSubstr("it fits the coordinates of control point P4: are their names swapped?"));
}

TEST_F(ReconstructWithControl, ABlunderIsNamedAndLeftOut) {
  std::vector<SurveyedPoint> points = surveyed_points();
  points[1].given[0] += 100;
  const Outcome made = run(gcp_list(points));
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, HasSubstr("warning: control point P2 is 1"));
  EXPECT_THAT(made.err, HasSubstr("5 of 6 control points"));
}

TEST_F(ReconstructWithControl, AWrongMarkIsNamedAndLeftOut) {
  std::string list = gcp_list(surveyed_points());
  const std::size_t line = list.find("descent_0002.png P5"), start = list.rfind('\n', line) + 1;
  list.replace(start, line - start, "0.000 0.000 4.000 180.0 190.0 ");
  const Outcome made = run(list);
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err,
              HasSubstr("mark of control point P5 in image descent_0002.png at column 180.0, row 190.0"));
  EXPECT_THAT(made.err, HasSubstr("6 of 6 control points"));
}

TEST_F(ReconstructWithControl, ExchangedCoordinatesMirrorTheImages) {
  std::vector<SurveyedPoint> points = surveyed_points();
  for (SurveyedPoint& p : points) {
    p.at[2] = p.given[2] = 0;
    std::swap(p.given[0], p.given[1]);
  }
  const Outcome made = run(gcp_list(points));
  EXPECT_EQ(made.code, 1);
  EXPECT_THAT(made.err, HasSubstr("6 of 6 cameras look up"));
  EXPECT_THAT(made.err, HasSubstr("easting comes before northing"));
}

TEST_F(ReconstructWithControl, UnknownImagesAreNamed) {
  const std::string list = gcp_list(surveyed_points());
  const Outcome some = run(list + "-20.000 -15.000 0.000 10 10 IMG_9999.JPG P1\n");
  EXPECT_EQ(some.code, 0) << some.err;
  EXPECT_THAT(some.err, HasSubstr("in 1 images that are not there were left out: IMG_9999.JPG"));
  const Outcome all = run("local\n0 0 0 10 10 IMG_9999.JPG P1\n");
  EXPECT_EQ(all.code, 1);
  EXPECT_THAT(all.err,
              HasSubstr("none of the marks is in one of the 6 images; the first names 'IMG_9999.JPG'"));
}

TEST_F(ReconstructWithControl, PosesAndControlExcludeEachOther) {
  const Outcome both = run("local\n", {"--cameras", (surveyed_flight() / "truth/cameras.json").string()});
  EXPECT_EQ(both.code, 2);
  EXPECT_THAT(both.err, HasSubstr("--lens and --cameras are both given"));
  const Outcome marks = waymark({"reconstruct", (surveyed_flight() / "images").string(), "--cameras",
                                 (surveyed_flight() / "truth/cameras.json").string(), "--control",
                                 folder_ / "gcp_list.txt", "--marks", "marks.csv", "-o", folder_ / "out"});
  EXPECT_EQ(marks.code, 2);
  EXPECT_THAT(marks.err, HasSubstr("--marks and --cameras are both given"));
}

// The folder colmap of a reconstruction is read again: as it is, by its CRS, and tied by its cameras.
TEST_F(ReconstructWithControl, ColmapsTextComesBack) {
  ASSERT_EQ(run(gcp_list(surveyed_points())).code, 0);
  const json made = json::parse(text_of(folder_ / "out/cameras.json"));
  std::string table = "image,x,y,z\n";
  for (const json& image : made["images"])
    table += fmt::format("{},{},{},{}\n", std::string(image["name"]), double(image["centre"][0]) + 100,
                         double(image["centre"][1]), double(image["centre"][2]));
  write_text(folder_ / "centres.csv", table);
  const auto again = [&](std::vector<std::string> more) {
    std::vector<std::string> words{"reconstruct", (surveyed_flight() / "images").string(),
                                   "--until",     "poses",
                                   "-o",          folder_ / "again",
                                   "--crs",       "local"};
    words.insert(words.end(), more.begin(), more.end());
    return waymark(words);
  };
  const auto largest_difference = [&](double east) {
    const json found = json::parse(text_of(folder_ / "again/cameras.json"));
    double largest = 0;
    for (std::size_t i = 0; i < made["images"].size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        largest =
            std::max(largest, std::abs(double(found["images"][i]["centre"][axis]) -
                                       double(made["images"][i]["centre"][axis]) - (axis == 0 ? east : 0)));
    return largest;
  };
  const std::string colmap = folder_ / "out/colmap";
  const Outcome untied = again({"--cameras", colmap});
  EXPECT_EQ(untied.code, 1);
  EXPECT_THAT(untied.err, HasSubstr("has no position, direction or scale in the map"));
  for (const char* file : {"", "/images.txt"}) {
    const Outcome by_crs = again({"--cameras", colmap + file, "--camera-crs", "local"});
    ASSERT_EQ(by_crs.code, 0) << by_crs.err;
    EXPECT_LT(largest_difference(0), 1e-6);
  }
  const Outcome by_table = again({"--cameras", colmap, "--control", folder_ / "centres.csv"});
  ASSERT_EQ(by_table.code, 0) << by_table.err;
  EXPECT_LT(largest_difference(100), 1e-3);
  const Outcome unused =
      again({"--cameras", folder_ / "out/cameras.json", "--control", folder_ / "centres.csv"});
  EXPECT_THAT(unused.err, HasSubstr("are not used: the camera file states the frame"));
  EXPECT_LT(largest_difference(0), 1e-6);
}

}  // namespace
}  // namespace waymark::test
