// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <fstream>

#include "exporters/report/report_html.hpp"
#include "exporters/vector/detections.hpp"
#include "geodb/write_map.hpp"
#include "tests/exporters/small_map.hpp"

namespace waymark::test {
using namespace exporters;
namespace {

using test::content_of;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// A map of twelve craters found in a grey image of 600 x 400 pixels, one of them rejected.
class ReportOfImages : public ::testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(folder / "tile.pgm", std::ios::binary) << "P5 600 400 255\n" << std::string(240000, 'x');
    TypeRegistry types;
    register_landmark_types(types);
    ImageDetections found{.type = types.id("crater"),
                          .image = "tile.pgm",
                          .columns = 600,
                          .rows = 400,
                          .detections = {},
                          .georeference = {},
                          .gsd = Meters{2},
                          .sun_elevation = {},
                          .sun_azimuth = {}};
    for (int i = 0; i < 12; ++i) {
      Detection one;
      one.type = found.type;
      one.outline = {.x = 40.0 + 45 * i, .y = 100, .major = 10.0 + 3 * i, .minor = 10.0 + 3 * i, .angle = 0};
      one.confidence = 0.9;
      found.detections.push_back(one);
    }
    contents = detections_to_map(found, types);
    contents.run.version = "0.1.0";
    contents.observations[3].rejected = "rim <shadow>";
    contents.observations[3].landmark_uid.clear();
    std::erase_if(contents.landmarks,
                  [&](const Landmark& l) { return l.position.xyz == contents.observations[3].position.xyz; });
  }
  std::string report(const ReportOptions& options = {}) {
    geodb::write_map(folder / "map.gpkg", contents);
    write_report(folder / "map.gpkg", folder / "map.html", options);
    return content_of(folder / "map.html");
  }

  test::TemporaryFolder folder;
  geodb::MapContents contents;
};

TEST_F(ReportOfImages, ShowsTheImageWithWhatWasUsedAndRejected) {
  const std::string html = report();
  EXPECT_THAT(html, AllOf(HasSubstr("<h3>tile.pgm</h3>"), HasSubstr("data:image/jpeg;base64,/9j/"),
                          HasSubstr("11 crater"), HasSubstr("rejected: rim &lt;shadow&gt;"),
                          HasSubstr("The whole image"), HasSubstr("Its busiest part")));
  // the centre of pixel 40 is half a pixel from the corner the picture begins at; radius 5 px
  EXPECT_THAT(html, HasSubstr("<circle class='used' cx='40.5' cy='100.5' r='5.0'"));
  EXPECT_THAT(report({.images = 0}), Not(HasSubstr("data:image/jpeg")));
}

TEST_F(ReportOfImages, MissingImageIsReported) {
  std::filesystem::remove(folder / "tile.pgm");
  EXPECT_THAT(report(), AllOf(HasSubstr("The image file is missing"), Not(HasSubstr("data:image/jpeg"))));
}

TEST_F(ReportOfImages, CountsCratersPerAreaOfTheImages) {
  const std::string html = report();
  EXPECT_THAT(html, AllOf(HasSubstr("Cumulative size-frequency"), HasSubstr("R-plot"),
                          HasSubstr("the footprint of one image"),
                          HasSubstr("0.960\u00a0km\u00b2")));  // 1.2 x 0.8 km
  contents.images.clear();
  std::erase_if(contents.observations, [](const Observation&) { return true; });
  EXPECT_THAT(report(), AllOf(HasSubstr("Cumulative size-frequency"), Not(HasSubstr("R-plot")),
                              HasSubstr("The counting area is unknown")));
}

TEST_F(ReportOfImages, ReportsQualityAndCalibration) {
  const std::string html = report({.checks = {{.type = "crater",
                                               .claim = "confidence",
                                               .bins = {{0.2, 10, 2}, {0.9, 100, 91}},
                                               .expected_error = 0.008}}});
  EXPECT_THAT(html, AllOf(HasSubstr("<h2>Quality</h2>"), HasSubstr("Crater: confidence and truth"),
                          HasSubstr("100 landmarks claim 0.90, 0.91 are right"), HasSubstr("off by 0.008"),
                          HasSubstr("Observations that were rejected")));
}

TEST_F(ReportOfImages, SameMapGivesTheSameBytes) {
  const std::string once = report();
  EXPECT_EQ(report(), once);
}

}  // namespace
}  // namespace waymark::test
