// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <sys/mount.h>

#include "exporters/report/report_html.hpp"
#include "exporters/vector/export_map.hpp"
#include "geodb/write_map.hpp"
#include "small_map.hpp"

namespace waymark::test {
using namespace exporters;
namespace {

using test::error_of;
using ::testing::HasSubstr;

/// A disk of 200 kB, and a map whose export needs more.
class FullDisk : public ::testing::Test {
 protected:
  test::TemporaryFolder folder;
  std::filesystem::path disk = folder / "disk", map = folder / "map.gpkg";
  bool mounted = false;

  void SetUp() override {
    std::filesystem::create_directory(disk);
    mounted = ::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=200k") == 0;
    if (!mounted) GTEST_SKIP() << "a small tmpfs can only be mounted by root";
    geodb::MapContents contents = test::three_summits("EPSG:4326", -70, -32, 0.1);
    for (int i = 0; i < 6000; ++i) {
      contents.landmarks.push_back(contents.landmarks[0]);
      contents.landmarks.back().uid = "mt-" + std::to_string(i);
    }
    geodb::write_map(map, contents);
  }
  void TearDown() override {
    if (mounted) ::umount2(disk.c_str(), MNT_DETACH);
  }
};

TEST_F(FullDisk, EveryFormatSaysSoAndLeavesNothing) {
  for (const std::string name :
       {"tops.csv", "tops.geojson", "tops.kml", "tops.shp", "tops.fgb", "tops.gml"}) {
    const std::string message = error_of([&] { export_map(map, (disk / name).string()); });
    EXPECT_THAT(message, HasSubstr("cannot write " + name + ": the disk is full")) << message;
    EXPECT_THAT(message, HasSubstr("free some space"));
    EXPECT_THAT(test::names_in(disk), ::testing::IsEmpty());
  }
}

TEST_F(FullDisk, GeoPackageSaysSoToo) {
  EXPECT_THAT(error_of([&] { export_map(map, (disk / "tops.gpkg").string()); }), HasSubstr("full"));
}

TEST_F(FullDisk, ReportSaysSoToo) {
  EXPECT_THAT(error_of([&] { write_report(map, disk / "report.html"); }),
              HasSubstr("cannot write report.html: the disk is full"));
}

}  // namespace
}  // namespace waymark::test
