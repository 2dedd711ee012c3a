// SPDX-License-Identifier: Apache-2.0
// Waymark's own camera file, frames, and refused files.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "geo/similarity.hpp"
#include "importers/cameras/camera_set.hpp"
#include "importers/cameras/control_points.hpp"
#include "importers/images/image.hpp"
#include "tests/importers/camera_data.hpp"
#include "tests/importers/raster_maker.hpp"

namespace waymark::test {
using namespace importers;
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

json sample() {
  return json::parse(R"({
    "waymark_cameras": 1,
    "frame": {"axes": "grid", "crs": "EPSG:32651"},
    "sun": {"azimuth": 120, "elevation": 35},
    "cameras": {"descent": {"columns": 1024, "rows": 512, "fx": 900, "fy": 901, "cx": 511.5, "cy": 255.5,
                            "distortion": [-0.1, 0.02, 0.0002, -0.0001, 0]}},
    "images": [{"name": "a.png", "camera": "descent", "centre": [292710, 2731048, 186],
                "rotation": [[1, 0, 0], [0, -1, 0], [0, 0, -1]], "rotation_sd": 0.05, "position_sd": 0.3,
                "taken_utc": "2021-02-18T20:51:06Z"},
               {"name": "b.png", "camera": "descent"}]})");
}

CameraSet read(const json& file, const CameraImport& import = {}) {
  return import_cameras(write_text("cameras.json", file.dump(1)), "", import);
}

std::string refusal(const std::function<void(json&)>& change) {
  json file = sample();
  change(file);
  return message_of([&] { read(file); });
}

TEST(CameraFile, IsReadAsDocumented) {
  const CameraSet set = read(sample());
  EXPECT_EQ(set.format, "waymark");
  EXPECT_EQ(set.crs.id(), "EPSG:32651");
  ASSERT_EQ(set.images.size(), 2u);
  const PosedCamera& view = *set.images[0].view;
  EXPECT_EQ(view.centre().xyz, Eigen::Vector3d(292710, 2731048, 186));
  EXPECT_EQ(view.camera.fy, 901);
  EXPECT_EQ(view.camera.distortion[2], 0.0002);
  EXPECT_NEAR(view.covariance(0, 0), std::pow(0.05 * kRadiansPerDegree, 2), 1e-18);
  EXPECT_NEAR(view.covariance(5, 5), 0.09, 1e-12);
  EXPECT_EQ(set.images[0].sun->azimuth.value, 120);
  EXPECT_EQ(set.images[0].taken_utc, "2021-02-18T20:51:06Z");
  EXPECT_FALSE(set.images[1].view);
  EXPECT_LT((looks_along(view) - Eigen::Vector3d(0, 0, -1)).norm(), 1e-6);
}

TEST(CameraFile, ADeviationThatIsAbsentOr0IsThatOfTheImport) {
  const CameraImport import{.rotation_sd = Degrees{1}, .position_sd = Meters{2}};
  json file = sample();
  for (const bool is_zero : {false, true}) {
    if (is_zero)
      file["images"][0]["position_sd"] = 0;
    else
      file["images"][0].erase("position_sd");
    const PosedCamera view = *read(file, import).images[0].view;
    EXPECT_NEAR(view.covariance(0, 0), std::pow(0.05 * kRadiansPerDegree, 2), 1e-18);
    EXPECT_NEAR(view.covariance(5, 5), 4, 1e-12);
    EXPECT_EQ(read(file).images[0].view->covariance(5, 5), 0);
  }
}

TEST(CameraFile, QuaternionAndRotationAreTheSame) {
  json file = sample();
  file["images"][0].erase("rotation");
  file["images"][0]["quaternion"] = {0, 1, 0, 0};  // half a turn about x
  EXPECT_LT(turn_between(*read(file).images[0].view, *read(sample()).images[0].view), 1e-9);
}

TEST(CameraFile, AMotionTurnsAndGrowsWithTheFrame) {
  json file = sample();
  file["images"][0]["motion"] = {{"shift", {1, 2, 3}}, {"turn", {0.01, 0, -0.02}}};
  const PosedCamera view = *read(file).images[0].view;
  ASSERT_TRUE(view.motion);
  EXPECT_EQ(view.motion->shift, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(view.motion->turn, Eigen::Vector3d(0.01, 0, -0.02));
  file["frame"] = {{"axes", "arbitrary"}};
  const Similarity turn = similarity_from_text("2,0.7071067811865476,0,0,0.7071067811865476,100,200,300");
  const PosedCamera moved = *read(file, {.crs = "EPSG:32651", .map_from_frame = turn}).images[0].view;
  EXPECT_LT((moved.motion->shift - Eigen::Vector3d(-4, 2, 6)).norm(), 1e-9);  // x, y -> -y, x
  EXPECT_EQ(moved.motion->turn, view.motion->turn);
}

TEST(CameraFile, EveryMissingFieldIsNamedWithItsPlace) {
  for (const char* field : {"columns", "rows", "fx", "fy", "cx", "cy"})
    EXPECT_THAT(
        refusal([&](json& f) { f["cameras"]["descent"].erase(field); }),
        AllOf(HasSubstr("'" + std::string(field) + "' is missing"), HasSubstr("at /cameras/descent")));
  EXPECT_THAT(refusal([](json& f) { f["images"][0].erase("rotation"); }),
              AllOf(HasSubstr("'rotation' is missing"), HasSubstr("at /images/0")));
  EXPECT_THAT(refusal([](json& f) { f["images"][1].erase("name"); }), HasSubstr("at /images/1"));
  EXPECT_THAT(refusal([](json& f) { f.erase("frame"); }), HasSubstr("'frame' is missing"));
}

TEST(CameraFile, SaysWhatIsWrongWithAValue) {
  EXPECT_THAT(refusal([](json& f) {
                f["images"][0]["centre"] = {1, 2};
              }),
              HasSubstr("3 numbers, there are 2"));
  EXPECT_THAT(refusal([](json& f) { f["images"][0]["centre"][1] = "north"; }),
              HasSubstr("at /images/0/centre/1"));
  EXPECT_THAT(refusal([](json& f) { f["images"][0]["center"] = 1; }), HasSubstr("did you mean 'centre'?"));
  EXPECT_THAT(refusal([](json& f) { f["images"][0]["rotation"][2][2] = 1; }), HasSubstr("reflection"));
  EXPECT_THAT(refusal([](json& f) { f["images"][0]["rotation"][0][0] = 2; }), HasSubstr("no rotation"));
  EXPECT_THAT(refusal([](json& f) { f["images"][0]["camera"] = "ascent"; }), HasSubstr("no camera 'ascent'"));
  EXPECT_THAT(refusal([](json& f) {
                f["images"][0]["motion"] = {{"shift", {0, 0, 0}}, {"turn", {0, 12, 0}}};  // degrees
              }),
              AllOf(HasSubstr("turns by 12 rad"), HasSubstr("/images/0/motion/turn")));
  EXPECT_THAT(refusal([](json& f) {
                f["images"][0]["motion"] = {{"shift", {0, 0, 0}}};
              }),
              HasSubstr("'turn' is missing"));
  EXPECT_THAT(refusal([](json& f) { f["images"][0]["taken_utc"] = "2021-02-18T20:51:06"; }),
              HasSubstr("with Z or an offset"));
  EXPECT_THAT(refusal([](json& f) { f["sun"]["elevation"] = -3; }),
              AllOf(HasSubstr("below the horizon"), HasSubstr("/sun/elevation")));
  EXPECT_THAT(refusal([](json& f) { f["cameras"]["descent"]["fx"] = 0; }), HasSubstr("must be positive"));
  EXPECT_THAT(refusal([](json& f) { f["frame"]["axes"] = "ned"; }), HasSubstr("kinds: grid, enu"));
  EXPECT_THAT(refusal([](json& f) { f["waymark_cameras"] = 2; }), HasSubstr("layout 2"));
  EXPECT_THAT(refusal([](json& f) { f["images"] = json::array(); }), HasSubstr("names no images"));
  EXPECT_THAT(refusal([](json& f) { f["frame"]["crs"] = "EPSG:4326"; }), HasSubstr("not degrees"));
  EXPECT_THAT(refusal([](json& f) { f["cameras"]["descent"]["distortion"] = {-5}; }),
              HasSubstr("does not invert in"));
  EXPECT_THAT(message_of([] { import_cameras(write_text("c.json", "{\"waymark_cameras\": 1,"), "", {}); }),
              HasSubstr("not valid JSON"));
  EXPECT_THAT(message_of([] { import_cameras(write_text("c.txt", "hello"), "", {}); }),
              HasSubstr("of no known format"));
  EXPECT_THAT(message_of([] { import_cameras(write_text("c.txt", "hello"), "colmop", {}); }),
              HasSubstr("did you mean 'colmap'?"));
}

KnownLenses lenses_of(const json& file) {
  return import_lenses(write_text("lens.json", file.dump(1)));
}

TEST(CameraFile, ALensNeedsNeitherImagesNorAFrame) {
  json file = sample();
  file["cameras"]["descent"]["readout_time"] = 0.033;
  file.erase("frame"), file.erase("images");
  const KnownLenses known = lenses_of(file);
  ASSERT_EQ(known.lenses.size(), 1u);
  EXPECT_EQ(known.lenses[0].camera.fx, 900);
  EXPECT_EQ(known.lenses[0].readout_time, 0.033);
  EXPECT_TRUE(known.images.empty());
  EXPECT_THAT(message_of([&] { read(file); }), HasSubstr("names no images"));
  file["images"] = json::array();
  file["frame"] = {{"axes", "arbitrary"}};
  EXPECT_EQ(lenses_of(file).lenses.size(), 1u);
  file["cameras"]["descent"]["readout_time"] = -1;
  EXPECT_THAT(message_of([&] { lenses_of(file); }),
              AllOf(HasSubstr("a readout time of -1 s"), HasSubstr("/cameras/descent/readout_time")));
}

TEST(CameraFile, EntriesKeepTheirLensAndTheirTime) {
  json file = sample();
  file["cameras"]["second"] = file["cameras"]["descent"];
  file["cameras"]["second"]["fx"] = 950;
  file["images"][0]["taken_utc"] = "2021-02-18T20:51:06.25Z";
  file["images"][1]["camera"] = "second";
  const KnownLenses known = lenses_of(file);
  ASSERT_EQ(known.lenses.size(), 2u);
  const KnownLenses::Entry *a = find_entry(known, "flight/a.jpg"), *b = find_entry(known, "b.png");
  ASSERT_TRUE(a && b);
  EXPECT_EQ(known.lenses[*a->lens].camera.fx, 900);
  EXPECT_EQ(known.lenses[*b->lens].camera.fx, 950);
  EXPECT_EQ(a->taken_utc, "2021-02-18T20:51:06.250Z");
  EXPECT_EQ(find_entry(known, "c.png"), nullptr);
}

TEST(CameraFile, InteriorOrientationsAreLenses) {
  const KnownLenses known = import_lenses(write_text(
      "odm.json",
      R"({"v2 dji": {"projection_type": "brown", "width": 4000, "height": 3000, "focal_x": 0.8, "focal_y": 0.8,
          "c_x": 0, "c_y": 0, "k1": 0.01, "k2": 0, "p1": 0, "p2": 0, "k3": 0}})"));
  ASSERT_EQ(known.lenses.size(), 1u);
  EXPECT_EQ(known.lenses[0].camera.fx, 3200);
  EXPECT_TRUE(known.images.empty());
}

TEST(CameraFile, OfTwoImagesOfOneNameNeitherHasAPose) {
  json file = sample();
  file["images"].push_back(file["images"][0]);
  const CameraSet set = read(file);
  EXPECT_EQ(set.images.size(), 2u);
  EXPECT_FALSE(set.images[0].view);
  EXPECT_THAT(set.warnings, ElementsAre(HasSubstr("two images are named 'a.png'")));
}

TEST(CameraSet, FindsAnImageByFoldersNameOrStem) {
  CameraSet set;
  for (const char* name : {"left/1.jpg", "right/1.jpg", "2", "3.png"}) set.images.emplace_back().image = name;
  EXPECT_EQ(find_camera(set, "/data/left/1.jpg")->image, "left/1.jpg");
  EXPECT_EQ(find_camera(set, "/data/right/1.jpg")->image, "right/1.jpg");
  EXPECT_EQ(find_camera(set, "/data/1.jpg"), nullptr);  // ambiguous
  EXPECT_EQ(find_camera(set, "2.tif")->image, "2");
  EXPECT_EQ(find_camera(set, "x/3.tif")->image, "3.png");
  EXPECT_EQ(find_camera(set, "4.tif"), nullptr);
}

TEST(CameraFrames, EnuIsTurnedByTheConvergenceAndBodyFixedAgrees) {
  json enu = sample();
  enu["frame"] = {{"axes", "enu"}, {"origin", {120.95, 24.68, 50}}};
  enu["images"][0]["centre"] = {1000, -2000, 300};
  const PosedCamera a = *read(enu, {.crs = "EPSG:32651"}).images[0].view;
  // Upper edge to true north: in the grid, west of its central meridian, 0.86 deg to the east of grid north.
  const Eigen::Vector3d up = -a.grid_from_camera.transform.linear().col(1);
  EXPECT_NEAR(std::atan2(up.x(), up.y()) / kRadiansPerDegree, 0.852, 0.01);
  EXPECT_NEAR(a.centre().xyz.z(), 350 + (1000.0 * 1000 + 2000.0 * 2000) / 2 / 6.371e6,
              0.01);  // the Earth is round

  // The same camera from the centre of the Earth.
  const double lon = 120.95 * kRadiansPerDegree, lat = 24.68 * kRadiansPerDegree;
  const double e2 = 0.00669437999014, n = 6378137 / std::sqrt(1 - e2 * std::sin(lat) * std::sin(lat));
  const Eigen::Vector3d origin((n + 50) * std::cos(lat) * std::cos(lon),
                               (n + 50) * std::cos(lat) * std::sin(lon), (n * (1 - e2) + 50) * std::sin(lat));
  Eigen::Matrix3d axes;
  axes << -std::sin(lon), -std::sin(lat) * std::cos(lon), std::cos(lat) * std::cos(lon),  //
      std::cos(lon), -std::sin(lat) * std::sin(lon), std::cos(lat) * std::sin(lon),       //
      0, std::cos(lat), std::sin(lat);
  const Eigen::Vector3d centre = origin + axes * Eigen::Vector3d(1000, -2000, 300);
  const Eigen::Matrix3d rotation = axes * Eigen::Vector3d(1, -1, -1).asDiagonal();
  json fixed = enu;
  fixed["frame"] = {{"axes", "body_fixed"}};
  fixed["images"][0]["centre"] = {centre.x(), centre.y(), centre.z()};
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) fixed["images"][0]["rotation"][r][c] = rotation(r, c);
  const PosedCamera b = *read(fixed, {.crs = "EPSG:32651"}).images[0].view;
  EXPECT_LT((a.centre().xyz - b.centre().xyz).norm(), 1e-4);
  EXPECT_LT(turn_between(a, b), 1e-6);
}

// Mars 2020 came down at 18.44 N 77.45 E, 3391937 m from the centre: 2570 m below the areoid, which is
// 3394507 m there and not the 3396190 m of the maps' sphere. Without the offset heights are 1.7 km off.
TEST(CameraFrames, HeightsOfMarsNeedTheAreoid) {
  const double lon = 77.45 * kRadiansPerDegree, lat = 18.44 * kRadiansPerDegree, radius = 3391937.2;
  json file = sample();
  file["frame"] = {{"axes", "body_fixed"}};
  file["images"][0]["centre"] = {radius * std::cos(lat) * std::cos(lon),
                                 radius * std::cos(lat) * std::sin(lon), radius * std::sin(lat)};
  const std::string sphere = "+proj=tmerc +lat_0=18.44 +lon_0=77.45 +a=3396190 +b=3396190 +units=m +no_defs";
  const auto height = [&](double offset) {
    return read(file, {.crs = sphere, .height_offset = Meters{offset}}).images[0].view->centre().xyz.z();
  };
  EXPECT_NEAR(height(0), -4252.8, 0.1);
  EXPECT_NEAR(height(3396190 - 3394507.1), -2569.9, 0.1);
}

TEST(CameraFrames, WarnsWhereTheProjectionStretches) {
  json file = sample();
  file["frame"] = {{"axes", "body_fixed"}};
  file["images"][0]["centre"] = {700000, 3146000, 1073000};
  EXPECT_THAT(read(file, {.crs = "+proj=eqc +a=3396190 +b=3396190 +units=m"}).warnings,
              Contains(AllOf(HasSubstr("distorts shapes"), HasSubstr("+proj=tmerc"))));
}

TEST(CameraFrames, ArbitraryNeedsASimilarity) {
  json file = sample();
  file["frame"] = {{"axes", "arbitrary"}};
  EXPECT_THAT(message_of([&] { read(file, {.crs = "EPSG:32651"}); }), HasSubstr("control points"));
  EXPECT_THAT(message_of([&] { read(file); }), HasSubstr("does not name the CRS of the map"));
  const Similarity turn = similarity_from_text("2,0.7071067811865476,0,0,0.7071067811865476,100,200,300");
  file["images"][0]["centre"] = {1, 2, 3};
  const PosedCamera view = *read(file, {.crs = "EPSG:32651", .map_from_frame = turn}).images[0].view;
  EXPECT_LT((view.centre().xyz - Eigen::Vector3d(96, 202, 306)).norm(),
            1e-9);  // a quarter turn: x, y -> -y, x
  EXPECT_LT((-view.grid_from_camera.transform.linear().col(1) - Eigen::Vector3d(-1, 0, 0)).norm(), 1e-9);
  EXPECT_NEAR(view.covariance(3, 3), 4 * 0.09, 1e-9);
}

TEST(CameraFrames, ControlPointsMayBeCameraPositions) {
  json file = sample();
  file["frame"] = {{"axes", "arbitrary"}};
  file["images"].erase(1);
  const double places[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.5}};
  std::string table = "image,x,y,z\n";
  for (int i = 0; i < 4; ++i) {
    json image = sample()["images"][0];
    image["name"] = "p" + std::to_string(i) + ".jpg";
    image["centre"] = places[i];
    file["images"][static_cast<std::size_t>(i)] = image;
    table += "p" + std::to_string(i) + "," + std::to_string(500000 + 10 * places[i][0]) + "," +
             std::to_string(10 * places[i][1]) + "," + std::to_string(10 * places[i][2]) + "\n";
  }
  const CameraSet set = read(file, {.crs = "EPSG:32651", .control_points = write_text("points.csv", table)});
  EXPECT_THAT(set.warnings, Contains(AllOf(HasSubstr("4 control points"), HasSubstr("scale 10"))));
  EXPECT_LT((set.images[3].view->centre().xyz - Eigen::Vector3d(500010, 10, 5)).norm(), 1e-6);
  EXPECT_THAT(message_of([&] {
                read(file,
                     {.crs = "EPSG:32651", .control_points = write_text("p.csv", "image,x,y,z\nq,1,2,3\n")});
              }),
              AllOf(HasSubstr("no pose for the image 'q'"), HasSubstr("line 2")));
}

TEST(Similarity, IsFoundFromPoints) {
  for (int seed = 1; seed < 40; ++seed) {
    auto number = [&, n = 0]() mutable { return std::sin(12.9898 * seed + 78.233 * ++n) * 100; };
    Similarity truth{.scale = 0.1 + std::abs(number())};
    truth.rotation =
        Eigen::Quaterniond(number(), number(), number(), number()).normalized().toRotationMatrix();
    truth.shift = {500000 + number(), 5e6 + number(), number()};
    std::vector<Eigen::Vector3d> frame, map;
    for (int i = 0; i < 3 + seed % 4; ++i) {
      frame.emplace_back(number(), number(), number());
      map.push_back(truth * frame.back());
    }
    const Similarity found = estimate_similarity(frame, map);
    EXPECT_NEAR(found.scale / truth.scale, 1, 1e-9);
    EXPECT_LT((found.rotation - truth.rotation).norm(), 1e-9);
    EXPECT_LT(residual(found, frame, map), 1e-6);
  }
}

TEST(Similarity, RefusesDegeneratePoints) {
  const std::vector<Eigen::Vector3d> line{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}};
  EXPECT_THAT(message_of([&] { estimate_similarity(line, line); }), HasSubstr("on one line"));
  EXPECT_THAT(message_of([&] {
                estimate_similarity({line[0], line[1]}, {line[0], line[1]});
              }),
              HasSubstr("needs 3"));
  EXPECT_THAT(message_of([] { similarity_from_text("1,2,3"); }), HasSubstr("8 numbers"));
}

}  // namespace
}  // namespace waymark::test
