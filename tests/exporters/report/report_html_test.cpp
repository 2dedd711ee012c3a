// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/report_html.hpp"

#include <gmock/gmock.h>

#include "exporters/report/script_policy.hpp"
#include "geodb/write_map.hpp"
#include "tests/exporters/small_dem.hpp"
#include "tests/exporters/small_map.hpp"

namespace waymark::test {
using namespace exporters;
namespace {

using test::content_of;
using test::error_of;
using ::testing::HasSubstr;
using ::testing::Not;

class ReportHtml : public ::testing::Test {
 protected:
  test::TemporaryFolder folder;
  std::filesystem::path map = folder / "high_andes.gpkg", html = folder / "report.html";

  std::string report_of(const geodb::MapContents& contents) {
    geodb::write_map(map, contents);
    write_report(map, html);
    return content_of(html);
  }
};

geodb::MapContents andes() {
  return test::three_summits("EPSG:4326", -70.05, -32.65, 0.05);
}

TEST_F(ReportHtml, NeedsNothingButItself) {
  const std::string report = report_of(andes());
  EXPECT_THAT(report, Not(HasSubstr("<script")));
  EXPECT_THAT(report, Not(HasSubstr("://")));
  EXPECT_THAT(report, HasSubstr("<meta http-equiv='Content-Security-Policy' content=\"default-src 'none';"));
  EXPECT_THAT(report, Not(HasSubstr("url(")));
  for (const std::string attribute : {"src=", "href="})
    for (auto at = report.find(attribute); at != std::string::npos; at = report.find(attribute, at + 1))
      EXPECT_EQ(report.substr(at + attribute.size() + 1, 5), "data:");
}

TEST_F(ReportHtml, AnInteractiveOneAllowsItsOwnScriptOnly) {
  geodb::MapContents hostile = andes();
  hostile.landmarks[0].uid = "'><script>alert(1)</script>";
  geodb::write_map(map, hostile);
  write_report(map, html, {.interactive = true});
  const std::string report = content_of(html);
  EXPECT_THAT(report, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(report, Not(HasSubstr("://")));
  EXPECT_EQ(report.find("<script"), report.rfind("<script"));
  const auto from = report.find("<script>") + 8;
  const std::string script = report.substr(from, report.find("</script>") - from);
  EXPECT_THAT(report, HasSubstr(script_policy(script)));
  EXPECT_THAT(report, HasSubstr("<tr data-uid='mt-two' data-confidence='1.000' data-quality='"));
  write_report(map, folder / "static.html");
  EXPECT_THAT(content_of(folder / "static.html"), Not(HasSubstr("<script")));
}

TEST_F(ReportHtml, ShowsPlacesFeaturesAndCertifiedBounds) {
  const std::string report = report_of(andes());
  EXPECT_THAT(report, HasSubstr("<h1>High andes</h1>"));
  EXPECT_THAT(report, HasSubstr("Earth \u00b7 WGS 84 (EPSG:4326)"));
  EXPECT_THAT(report, HasSubstr("<td>32.6500\u00b0\u00a0S 70.0500\u00b0\u00a0W<small>mt-one</small></td>"));
  EXPECT_THAT(report, HasSubstr("<td>3000<small>\u00b1 5</small></td>"));
  EXPECT_THAT(report, HasSubstr("<td>500<small>at least 250</small></td>"));
}

TEST_F(ReportHtml, AccountsForTheRun) {
  const std::string report = report_of(andes());
  EXPECT_THAT(
      report,
      HasSubstr("Find mountain tops</th><td>120</td><td>3</td>"
                "<td>117<small>117 prominence below 20 m</small></td><td>4<small>1 reused</small></td>"));
  EXPECT_THAT(report, HasSubstr("<li><b>Find mountain tops:</b> a seam &lt;disagrees&gt;</li>"));
  EXPECT_THAT(report, HasSubstr("<li><b>find_mountain_tops/tile_3 failed:</b> the file is damaged</li>"));
  EXPECT_THAT(report, HasSubstr("<code>waymark peaks dem.tif -o map.gpkg</code>"));
  EXPECT_THAT(report, HasSubstr("<td>dem.tif</td><td>1.2\u00a0MB</td><td><code>aaaa"));
}

TEST_F(ReportHtml, DrawsTheReliefOfTheInputFiles) {
  geodb::MapContents contents = andes();
  test::write_small_dem(folder / "dem.tif", -70.1, -32.55, 0.001);
  contents.run.inputs = {
      {"elsewhere/dem.tif", std::filesystem::file_size(folder / "dem.tif"), ""}};  // beside the map
  EXPECT_THAT(report_of(contents), HasSubstr("href='data:image/png;base64,iVBORw0KGgo"));
  contents.run.inputs[0].bytes -= 1;  // no longer the input file of the run
  EXPECT_THAT(report_of(contents), Not(HasSubstr("data:image/png")));
}

TEST_F(ReportHtml, SameMapGivesTheSameBytes) {
  const std::string once = report_of(andes());
  EXPECT_EQ(report_of(andes()), once);
}

TEST_F(ReportHtml, MapWithoutLandmarksOrRunStillHasAReport) {
  geodb::MapContents contents;
  register_landmark_types(contents.types);
  contents.crs = Crs::from_text("IAU_2015:49900");
  const std::string report = report_of(contents);
  EXPECT_THAT(report, HasSubstr("This map has no landmarks yet."));
  EXPECT_THAT(report, HasSubstr("Mars"));
}

TEST_F(ReportHtml, LocalMapHasAScaleButNoNorth) {
  const std::string report = report_of([] {
    geodb::MapContents contents = test::three_summits("EPSG:4326", 5, 5, 10);
    contents.crs = Crs::local();
    return contents;
  }());
  EXPECT_THAT(report, HasSubstr("class='scale'"));
  EXPECT_THAT(report, Not(HasSubstr("class='north'")));
}

TEST_F(ReportHtml, TitleCannotCarryMarkup) {
  geodb::write_map(map, andes());
  write_report(map, html, {.title = "<b>& more"});
  EXPECT_THAT(content_of(html), HasSubstr("<h1>&lt;b&gt;&amp; more</h1>"));
}

TEST_F(ReportHtml, MissingFolderSaysSo) {
  geodb::write_map(map, andes());
  EXPECT_THAT(error_of([&] { write_report(map, folder / "nowhere/report.html"); }),
              HasSubstr("cannot write report.html: its folder does not exist"));
}

}  // namespace
}  // namespace waymark::test
