// SPDX-License-Identifier: Apache-2.0
// Tracks written in a CRS and read back, and tables of other programs.
#include "exporters/vector/track_file.hpp"

#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <ogrsf_frmts.h>

#include <functional>
#include <string_view>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/random.hpp"
#include "core/text_file.hpp"
#include "exporters/vector/track_formats.hpp"
#include "tests/exporters/small_map.hpp"

namespace waymark::test {
namespace {

using namespace exporters;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

localization::Track made_track() {
  Random random(4, "track");
  localization::Track track;
  for (int i = 0; i < 50; ++i) {
    localization::TrackRow& row = track.rows.emplace_back();
    row.t = i;
    row.at.pose = {random.uniform(-900, 900), random.uniform(-900, 900), random.uniform(-3, 3)};
    row.at.covariance << 0.04, 0.01, 0.001, 0.01, 0.09, 0.002, 0.001, 0.002, 0.0004;
    row.z = 700 + i;
  }
  return track;
}

std::string problem_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

class TrackFiles : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) {
    write_file(folder.path() / "t.csv", text);
    return folder.path() / "t.csv";
  }
  TemporaryFolder folder;
};

TEST_F(TrackFiles, OnesInACrsNameItAndComeBackToTheFrame) {
  const localization::Track track = made_track();
  for (const char* name : {"EPSG:32633", "+proj=stere +lat_0=90 +lon_0=30 +datum=WGS84 +units=m"}) {
    const Crs crs = Crs::from_text(name);
    const Point<MapCrs> origin = std::string(name) == "EPSG:32633" ? Point<MapCrs>{{300000, 5200000, 700}}
                                                                   : Point<MapCrs>{{400000, -300000, 700}};
    const LocalFrame frame(crs, origin);
    const auto file = folder.path() / "crs.csv";
    write_track_csv(file, track, {.frame = &frame, .crs = &crs});
    EXPECT_TRUE(Crs::from_text(read_track_file(file).crs).same_as(crs)) << name;
    const localization::Track back = read_track(file, &frame);
    ASSERT_EQ(back.rows.size(), track.rows.size());
    for (std::size_t i = 0; i < track.rows.size(); ++i) {
      const auto &a = track.rows[i].at, &b = back.rows[i].at;
      EXPECT_NEAR(a.pose.x, b.pose.x, 2e-6);  // six decimals are written
      EXPECT_NEAR(a.pose.y, b.pose.y, 2e-6);
      EXPECT_NEAR(localization::wrap_angle(a.pose.yaw - b.pose.yaw), 0, 2e-6);
      EXPECT_TRUE(a.covariance.isApprox(b.covariance, 1e-4)) << b.covariance;
    }
    EXPECT_THAT(problem_of([&] { read_track(file, nullptr); }), HasSubstr("not in the frame of its map"));
    const LocalFrame other(Crs::from_text("EPSG:32632"), {{500000, 5200000, 0}});
    EXPECT_THAT(problem_of([&] { read_track(file, &other); }), HasSubstr("the map in EPSG:32632"));
  }
}

TEST_F(TrackFiles, GeoPackagesAreReadBack) {
  localization::Track track = made_track();
  for (localization::TrackRow& row : track.rows) row.matched = 2;
  const auto file = folder.path() / "t.gpkg";
  for (const char* name : {"local", "EPSG:32633"}) {
    const bool is_local = std::string_view(name) == "local";
    const Crs crs = is_local ? Crs::local() : Crs::from_text(name);
    const LocalFrame frame(crs, is_local ? Point<MapCrs>{} : Point<MapCrs>{{300000, 5200000, 700}});
    write_track_geopackage(file, track, {.frame = &frame, .crs = &crs});
    EXPECT_EQ(read_track_file(file).crs.empty(), is_local);
    const localization::Track back = read_track(file, &frame);
    ASSERT_EQ(back.rows.size(), track.rows.size());
    for (std::size_t i = 0; i < track.rows.size(); ++i) {
      const auto &a = track.rows[i].at, &b = back.rows[i].at;
      EXPECT_EQ(back.rows[i].t, track.rows[i].t);
      EXPECT_EQ(back.rows[i].matched, 2);
      EXPECT_NEAR(a.pose.x, b.pose.x, 1e-6);
      EXPECT_NEAR(a.pose.y, b.pose.y, 1e-6);
      EXPECT_NEAR(localization::wrap_angle(a.pose.yaw - b.pose.yaw), 0, 1e-6);
      EXPECT_TRUE(a.covariance.isApprox(b.covariance, 1e-6)) << b.covariance;
    }
    EXPECT_EQ(back.named, 0) << "wrong matches are not known";
  }
  write_small_map(folder.path() / "map.gpkg");
  EXPECT_THAT(problem_of([&] { read_track_file(folder.path() / "map.gpkg"); }),
              HasSubstr("no layer 'track'"));
}

// Readers take the CRS 0, which GDAL writes without one, for degrees.
TEST_F(TrackFiles, AGeoPackageInLocalMetresIsCartesian) {
  const Crs local = Crs::local();
  const LocalFrame frame(local, {});
  const auto file = folder.path() / "t.gpkg";
  write_track_geopackage(file, made_track(), {.frame = &frame, .crs = &local});
  EXPECT_THAT(content_of(file), HasSubstr("Undefined Cartesian SRS"));
  GDALDatasetUniquePtr set(GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR));
  ASSERT_TRUE(set);
  const OGRSpatialReference* srs = set->GetLayerByName("track")->GetSpatialRef();
  EXPECT_TRUE(srs == nullptr || !srs->IsGeographic()) << srs->GetName();
}

TEST_F(TrackFiles, PosesWithoutTimesAreNamed) {
  const auto file = folder.path() / "poses";
  write_track_poses(file, made_track(), TrackFormat::kitti);
  EXPECT_THAT(problem_of([&] { read_track_file(file); }), HasSubstr("poses of KITTI have no times"));
  write_track_poses(file, made_track(), TrackFormat::g2o);
  EXPECT_THAT(problem_of([&] { read_track_file(file); }), HasSubstr("poses of g2o have no times"));
  write_track_poses(file, made_track(), TrackFormat::tum);
  EXPECT_EQ(read_track_file(file).track.rows.size(), 50u);
}

TEST_F(TrackFiles, OnesInTheMapFrameNameNoCrs) {
  const auto file = folder.path() / "plain.csv";
  write_track_csv(file, made_track());
  EXPECT_EQ(read_track_file(file).crs, "");
  EXPECT_THAT(read_text(file, "it"), Not(HasSubstr("crs")));
  const Crs local = Crs::local();
  const LocalFrame frame(local, {});
  write_track_csv(file, made_track(), {.frame = &frame, .crs = &local});
  EXPECT_EQ(read_track_file(file).crs, "") << "both frames agree";
}

TEST_F(TrackFiles, BomSemicolonsAndTabsAreRead) {
  for (const char* text :
       {"\xEF\xBB\xBFt,x,y,yaw\n1,2,3,0.5\n2,4,5,0.6\n", "t;x;y;yaw\r\n1;2;3;0.5\r\n2;4;5;0.6\r\n",
        "t\tx\ty\tyaw\n1\t2\t3\t0.5\n2\t4\t5\t0.6\n",
        "\"t\", \"x\", \"y\", \"yaw\"\n1, 2, 3, 0.5\n2, 4, 5, 0.6\n"}) {
    const TrackFile read = read_track_file(write(text));
    ASSERT_EQ(read.track.rows.size(), 2u) << text;
    EXPECT_EQ(read.track.rows[1].at.pose.y, 5) << text;
    EXPECT_EQ(read.track.rows[0].at.pose.yaw, 0.5) << text;
  }
}

TEST_F(TrackFiles, BrokenLinesAreNamed) {
  EXPECT_THAT(problem_of([&] { read_track_file(write("t;x;y\n1;2,5;3\n")); }),
              testing::AllOf(HasSubstr("column 2 of the track is no number"), HasSubstr("decimal points")));
  EXPECT_THAT(problem_of([&] { read_track_file(write("t,x,y\n1,2,5,3\n")); }),
              HasSubstr("4 values for 3 columns"));
  EXPECT_THAT(problem_of([&] { read_track_file(write("t,x,y,crs\n1,2,5,EPSG:32632\n2,2,5,EPSG:32633\n")); }),
              HasSubstr("in one CRS"));
  EXPECT_THAT(problem_of([&] { read_track_file(write("t,x,y,crs\n1,2,5,EPSG:nonsense\n")); }),
              Not(StartsWith("no error")));
}

}  // namespace
}  // namespace waymark::test
