// SPDX-License-Identifier: Apache-2.0
#include <gdal_priv.h>
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <tuple>

#include "core/units.hpp"
#include "exporters/report/relief_picture.hpp"
#include "exporters/view/make_scene.hpp"
#include "exporters/view/view_drive.hpp"
#include "exporters/view/view_form.hpp"
#include "exporters/view/view_frame.hpp"
#include "exporters/view/view_page.hpp"
#include "exporters/view/view_terrain.hpp"
#include "geodb/write_map.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/engine/sha256.hpp"
#include "tests/exporters/small_dem.hpp"
#include "tests/exporters/small_map.hpp"

namespace waymark::test {
using namespace exporters;
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class ViewSceneOfMap : public ::testing::Test {
 protected:
  /// Returns the scene of a map; its frame is about the first landmark, as for a robot.
  ViewScene scene_of(const geodb::MapContents& contents, ViewRequest request = {}) {
    const auto file = folder / "map.gpkg";
    geodb::write_map(file, contents);
    const auto map = geodb::MapStore::open(file);
    const Point<MapCrs> origin =
        contents.landmarks.empty() ? Point<MapCrs>{} : contents.landmarks.front().position;
    const LocalFrame frame(map.crs(), {{origin.xyz.x(), origin.xyz.y(), 0}});
    return make_view_scene(map, frame, request);
  }

  std::string dem(double west, double north, double cell) {
    const auto file = folder / "dem.tif";
    write_small_dem(file, west, north, cell);
    return file.string();
  }

  TemporaryFolder folder;
};

TEST(ViewForm, ShapesFollowFromTheDeclarations) {
  TypeRegistry types;
  register_landmark_types(types);
  std::map<std::string, std::string> shapes;
  for (const LandmarkType& type : types) shapes[type.name] = view_shape(type);
  const std::map<std::string, std::string> expected{
      {"beacon", "cylinder"},    {"building", "block"},     {"crater", "bowl"},     {"door", "portal"},
      {"lane_mark", "strip"},    {"mountain_top", "cone"},  {"pillar", "cylinder"}, {"pole", "cylinder"},
      {"rock", "cylinder"},      {"traffic_sign", "plate"}, {"tree", "canopy"},     {"wall", "panel"},
      {"wall_corner", "corner"}, {"wall_end", "end"}};
  for (const auto& [name, shape] : expected) EXPECT_EQ(shapes[name], shape) << name;
  for (const auto& [name, shape] : shapes)
    EXPECT_EQ(is_oriented(shape), testing::Matches(testing::AnyOf("panel", "corner", "end", "plate", "block",
                                                                  "strip", "portal"))(shape));
  // A type of a plug-in is drawn by its own declaration.
  const LandmarkType fence{
      .name = "fence",
      .summary = "",
      .features = {{"facing", "rad", Scale::direction, -4, 4, ""}, {"length", "m", Scale::ratio, 0, 99, ""}}};
  EXPECT_EQ(view_shape(fence), "panel");
}

TEST(ViewForm, DirectionsAreTurnedFromTheGridToTheView) {
  TypeRegistry types;
  register_landmark_types(types);
  const LandmarkType& type = types[types.id("wall")];
  const Crs utm = Crs::from_text("EPSG:32632");
  const ViewFrame frame(utm, LocalFrame(utm, {{700000, 5200000, 0}}), Eigen::Vector3d::Zero());
  Landmark wall;
  wall.position = {{700000, 5200000, 0}};
  wall.features = {{std::numbers::pi / 2, 0, 1}, {12, 0, 1}, {}};  // it faces grid east, 12 m long
  const ViewForm form = view_form(wall, type, frame);
  // Grid east lies clockwise of true east where the grid's north lies east of true north.
  const double convergence =
      std::atan(std::tan(2.63 * kRadiansPerDegree) * std::sin(46.93 * kRadiansPerDegree));
  EXPECT_NEAR(form.turn, -convergence, 2e-3);
  EXPECT_EQ(form.length, 12);
  EXPECT_TRUE(std::isnan(form.width));
}

int count_of(const std::string& text, const std::string& part) {
  int count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// Returns the JSON of the page.
nlohmann::json data_of(const std::string& page) {
  const std::string head = "<script type='application/json' id='scene'>";
  const auto from = page.find(head) + head.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

TEST_F(ViewSceneOfMap, LandmarksAreMetresApart) {
  // 0.1 degrees of latitude at 32.6 S are 11 089 m on WGS 84, 0.1 degrees of longitude 9 383 m.
  const ViewScene scene = scene_of(three_summits("EPSG:4326", -70.01, -32.65, 0.1));
  ASSERT_EQ(scene.layers.size(), 1u);
  ASSERT_EQ(scene.layers[0].landmarks.size(), 3u);
  const auto& l = scene.layers[0].landmarks;
  EXPECT_NEAR((l[1].at - l[0].at).head<2>().norm(), 9383, 10);
  EXPECT_NEAR((l[2].at - l[0].at).head<2>().norm(), 11089, 10);
  EXPECT_EQ(scene.layers[0].shape, "cone");
  EXPECT_EQ(l[0].uid, "mt-one");
  EXPECT_FLOAT_EQ(l[0].features[0][0], 3000);
  EXPECT_FLOAT_EQ(l[0].features[0][1], 5);
  EXPECT_FLOAT_EQ(l[0].sd[0], 30);
}

TEST_F(ViewSceneOfMap, DeviationsOfPositionsAreThoseEastAndNorth) {
  // South polar stereographic of the Moon: x grows to the east at 0 degrees, to the north at 90 degrees.
  for (const auto& [x, y, east, north] : {std::tuple(0.0, 30000.0, 30, 2), std::tuple(30000.0, 0.0, 2, 30)}) {
    geodb::MapContents map = three_summits("IAU_2015:30135", x, y, 50);
    for (Landmark& l : map.landmarks)
      l.covariance.topLeftCorner<2, 2>() = Eigen::Vector2d(900, 4).asDiagonal();
    const ViewScene scene = scene_of(map);
    EXPECT_NEAR(scene.layers.at(0).landmarks.at(0).sd[0], east, 0.1);
    EXPECT_NEAR(scene.layers.at(0).landmarks.at(0).sd[1], north, 0.1);
  }
}

TEST_F(ViewSceneOfMap, PositionsAreSmallNumbersFarFromTheOriginOfTheCrs) {
  geodb::MapContents map = three_summits("EPSG:32719", 400000, 6400000, 50);
  const ViewScene scene = scene_of(map);
  for (const ViewLandmark& l : scene.layers[0].landmarks) EXPECT_LT(l.at.head<2>().norm(), 100);
}

TEST_F(ViewSceneOfMap, CrossesTheAntimeridian) {
  geodb::MapContents map = three_summits("EPSG:4326", 179.95, 10, 0.05);
  map.landmarks[1].position.xyz.x() = -179.95;
  const ViewScene scene = scene_of(map);
  ASSERT_EQ(scene.layers[0].landmarks.size(), 3u);
  EXPECT_LT(scene.radius, 20000);  // 0.1 degrees apart
}

TEST_F(ViewSceneOfMap, TerrainHasTheHeightsOfTheDem) {
  const ViewScene scene =
      scene_of(three_summits("EPSG:4326", -70.05, -32.65, 0.02), {.dems = {dem(-70.1, -32.6, 0.001)}});
  const Grid<float>& heights = scene.terrain.heights;
  ASSERT_GT(heights.columns(), 100);
  EXPECT_LE(std::max(heights.columns(), heights.rows()), TerrainBudget{}.nodes);
  float highest = -std::numeric_limits<float>::infinity();
  std::int64_t at_column = 0, at_row = 0;
  for (std::int64_t r = 0; r < heights.rows(); ++r)
    for (std::int64_t c = 0; c < heights.columns(); ++c)
      if (heights(c, r) > highest) highest = heights(c, r), at_column = c, at_row = r;
  // The peak of the cone is between four cells of 1000 - 10 * 0.7 m, at -70.05, -32.65: the first summit.
  const double base = 1000;  // of the lowest landmark, the zero of heights
  EXPECT_NEAR(highest + base, 993, 8);
  const Eigen::Vector3f& summit = scene.layers[0].landmarks[0].at;
  EXPECT_NEAR(scene.terrain.west + scene.terrain.step * double(at_column), summit.x(), 150);
  EXPECT_NEAR(scene.terrain.south + scene.terrain.step * double(heights.rows() - 1 - at_row), summit.y(),
              150);
  EXPECT_EQ(scene.terrain.picture.substr(0, 3), "\xFF\xD8\xFF");
}

TEST_F(ViewSceneOfMap, AWideDemIsCutToTheLandmarks) {
  const ViewScene scene =
      scene_of(three_summits("EPSG:4326", -70.05, -32.65, 0.001), {.dems = {dem(-70.55, -32.15, 0.01)}});
  EXPECT_LT(scene.radius, 500);  // landmarks 100 m apart on a DEM of 100 km
}

TEST_F(ViewSceneOfMap, OtherBodiesHaveTheirOwnDegrees) {
  // One degree of latitude is 59.2 km on Mars.
  const ViewScene scene = scene_of(three_summits("IAU_2015:49900", 226.2, 18.65, 1));
  const auto& l = scene.layers[0].landmarks;
  EXPECT_NEAR((l[2].at - l[0].at).norm(), 59200, 300);
  EXPECT_THAT(scene.place, HasSubstr("Mars"));
}

TEST_F(ViewSceneOfMap, DrawsTheForemostOfTooManyAndSaysSo) {
  geodb::MapContents map = three_summits("EPSG:4326", -70.05, -32.65, 0.01);
  map.landmarks.resize(2);
  const Landmark one = map.landmarks[1];
  for (int i = 0; i < 98; ++i) {
    map.landmarks.push_back(one);
    map.landmarks.back().uid = "mt-" + std::to_string(i);
    map.landmarks.back().position.xyz.x() += 0.0001 * i;
  }
  const ViewScene scene = scene_of(map, {.max_landmarks = 10});
  EXPECT_EQ(scene.layers[0].landmarks.size(), 10u);
  EXPECT_EQ(scene.layers[0].total, 100);
  EXPECT_EQ(scene.layers[0].landmarks[0].uid, "mt-one");  // the most prominent
  EXPECT_THAT(scene.notes, testing::Contains("10 of 100 landmarks of type mountain top are drawn"));
}

TEST_F(ViewSceneOfMap, AnEmptyMapWithoutTerrainIsRefused) {
  geodb::MapContents map = three_summits("EPSG:4326", -70.05, -32.65, 0.01);
  map.landmarks.clear();
  EXPECT_THAT(error_of([&] { scene_of(map); }), HasSubstr("there is nothing to show"));
}

TEST_F(ViewSceneOfMap, AFileThatIsNoElevationModelIsRefused) {
  const auto file = folder / "not_a_dem.tif";
  std::ofstream(file) << "no image";
  EXPECT_THAT(error_of([&] {
                scene_of(three_summits("EPSG:4326", -70.05, -32.65, 0.01), {.dems = {file.string()}});
              }),
              HasSubstr("no elevation model of this map's body"));
}

TEST_F(ViewSceneOfMap, EvidenceNamesItsImages) {
  geodb::MapContents map = three_summits("EPSG:4326", -70.05, -32.65, 0.01);
  for (int i = 0; i < 11; ++i) {
    Observation seen;
    seen.type = map.landmarks[0].type;
    seen.landmark_uid = "mt-one";
    seen.source = "image_" + std::to_string(i) + ".png";
    seen.position = map.landmarks[0].position;
    seen.covariance = map.landmarks[0].covariance;
    seen.features = map.landmarks[0].features;
    seen.confidence = 0.5;
    map.observations.push_back(seen);
  }
  const ViewScene scene = scene_of(map);
  EXPECT_EQ(scene.layers[0].landmarks[0].evidence.size(), 8u);  // the others are counted
  EXPECT_TRUE(scene.layers[0].landmarks[1].evidence.empty());
  EXPECT_EQ(scene.sources.at(0), "image_0.png");
}

TEST_F(ViewSceneOfMap, PagesAreEqualByteForByte) {
  const geodb::MapContents map = three_summits("EPSG:4326", -70.05, -32.65, 0.02);
  const ViewRequest request{.dems = {dem(-70.1, -32.6, 0.001)}};
  EXPECT_EQ(view_page(scene_of(map, request)), view_page(scene_of(map, request)));
}

TEST(ViewPage, NeedsNothingButItself) {
  const std::string page = view_page({.title = "A map", .place = "local metres"});
  EXPECT_THAT(page, Not(HasSubstr("://")));
  EXPECT_THAT(page, Not(HasSubstr("url(")));
  EXPECT_THAT(page, Not(HasSubstr(" src=")));
  EXPECT_EQ(count_of(page, "<script"), 2);  // the data and the program
  EXPECT_THAT(page, HasSubstr("default-src 'none'; script-src 'sha256-"));
}

TEST(ViewPage, AllowsItsOwnScriptOnly) {
  const std::string page = view_page({.title = "A map"});
  const auto from = page.rfind("<script>") + 8;
  const std::string script = page.substr(from, page.rfind("</script>") - from);
  EXPECT_THAT(script, HasSubstr("getContext('webgl2'"));
  EXPECT_THAT(script, Not(HasSubstr("</script")));
  // Base64 of the hash, computed by hand here from its hexadecimal digits.
  const std::string hex = pipeline::sha256(script);
  std::string bits;
  for (const char c : hex)
    for (int bit = 3; bit >= 0; --bit)
      bits += ((std::stoi(std::string(1, c), nullptr, 16) >> bit) & 1) ? '1' : '0';
  std::string base64;
  for (std::size_t i = 0; i + 6 <= bits.size() + 4; i += 6) {
    const std::string six = (bits + "0000").substr(i, 6);
    base64 += "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"[std::stoi(six, nullptr, 2)];
  }
  EXPECT_THAT(page, HasSubstr("script-src 'sha256-" + base64 + "='"));
}

TEST(ViewPage, MarkupInAnyTextStaysText) {
  const std::string bad = "</script><script>alert(1)</script><!--<img src=x onerror=alert(1)>'\"";
  ViewScene scene{.title = bad, .place = bad, .notes = {bad}};
  ViewLayer layer{.name = bad, .title = bad, .colour = "#123456", .shape = bad, .total = 1};
  layer.features.push_back({bad, bad, {.unit = bad}});
  ViewLandmark landmark{.uid = bad, .position = bad, .label = bad};
  landmark.features.push_back({1, 0});
  layer.landmarks.push_back(landmark);
  scene.layers.push_back(layer);
  scene.sources.push_back(bad);
  scene.tracks.push_back({.name = bad});
  scene.images.push_back({.name = bad});
  scene.terrain.caption = bad;
  const std::string page = view_page(scene);
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  EXPECT_EQ(count_of(page, "<script"), 2);
  EXPECT_EQ(data_of(page)["layers"][0]["uids"][0], bad);
}

TEST(ViewPage, BrokenUtf8DoesNotStopIt) {
  EXPECT_NO_THROW(view_page({.title = "caf\xE9", .notes = {"\xFF\xFE"}}));
}

/// A scene as large as the budgets allow: noise that JPEG cannot compress, and the most of everything.
TEST(ViewPage, TheLargestSceneHasLessThanTenMegabytes) {
  std::mt19937 random(1);
  const auto noise = [&](std::int64_t pixels) {
    Grid<Colour> picture(pixels, pixels);
    for (Colour& c : picture.cells())
      c.red = c.green = c.blue = static_cast<std::uint8_t>(128 + static_cast<int>(random() % 32));
    return encode_jpeg(picture, 84);
  };
  ViewScene scene{.title = "Everything"};
  scene.terrain.heights = Grid<float>(TerrainBudget{}.nodes, TerrainBudget{}.nodes);
  for (float& h : scene.terrain.heights.cells()) h = static_cast<float>(random() % 1000);
  scene.terrain.picture = noise(TerrainBudget{}.pixels);
  ViewLayer layer{.name = "rock", .title = "Rock", .colour = "#123456", .shape = "cylinder", .total = 24000};
  layer.features.resize(3);
  for (int i = 0; i < ViewRequest{}.max_landmarks; ++i) {
    ViewLandmark l{.uid = "ro-5zwre0f0hcn2n", .position = "E 412 345.1 N 3 789 012.3"};
    l.features.assign(3, {1.5F, 0.5F});
    l.evidence.assign(4, {});
    layer.landmarks.push_back(l);
  }
  scene.layers.push_back(layer);
  for (int i = 0; i < 4; ++i) {
    scene.tracks.emplace_back();
    scene.tracks.back().poses.resize(DriveBudget{}.poses);
  }
  scene.scans.resize(DriveBudget{}.scans);
  for (ViewScan& scan : scene.scans) scan.rays.resize(DriveBudget{}.rays);
  EXPECT_LT(view_page(scene).size(), 10'000'000u);
}

TEST(ViewDrive, KeepsTheFirstAndTheLastPoseOfAThinnedTrack) {
  const ViewFrame frame(Crs::local(), LocalFrame(Crs::local(), {}), {100, 50, 0});
  localization::Track track;
  for (int i = 0; i < 1000; ++i) {
    localization::TrackRow row;
    row.t = i;
    row.at.pose = {100.0 + i, 50, 0.5};
    row.at.covariance.diagonal() << 4, 9, 0.01;
    track.rows.push_back(row);
  }
  const ViewTrack view = make_view_track("ekf", track, frame, {.poses = 11});
  ASSERT_EQ(view.poses.size(), 11u);
  EXPECT_EQ(view.poses.front().t, 0);
  EXPECT_EQ(view.poses.back().t, 999);
  EXPECT_FLOAT_EQ(view.poses.back().x, 999);
  EXPECT_FLOAT_EQ(view.poses.back().y, 0);
  EXPECT_FLOAT_EQ(view.poses[5].var_y, 9);
}

TEST(ViewDrive, LeavesOutPosesThatAreNotNumbers) {
  const ViewFrame frame(Crs::local(), LocalFrame(Crs::local(), {}), {0, 0, 0});
  localization::Track track;
  track.rows.resize(3);
  track.rows[1].at.pose.x = std::nan("");
  EXPECT_EQ(make_view_track("ekf", track, frame).poses.size(), 2u);
}

TEST(ViewDrive, BeamsWithoutReturnAreLeftOut) {
  localization::RobotLog log;
  localization::LaserScan scan;
  scan.robot_from_sensor = {1, 0, 0.25};
  scan.first_angle = -0.5;
  scan.angle_step = 0.5;
  scan.max_range = 20;
  scan.ranges = {3, std::nanf(""), 20, -1, 4};
  localization::SightingSet seen;
  seen.sightings.resize(2);
  seen.sightings[0].bearing = 0.1;
  seen.sightings[0].range = 7;  // the second one has no range
  log.events = {{5, scan}, {6, seen}};
  const std::vector<ViewScan> scans = make_view_scans(log);
  ASSERT_EQ(scans.size(), 2u);
  ASSERT_EQ(scans[0].rays.size(), 2u);
  EXPECT_FLOAT_EQ(scans[0].rays[0].bearing, -0.25F);
  EXPECT_FLOAT_EQ(scans[0].rays[1].bearing, 1.75F);
  EXPECT_FLOAT_EQ(scans[0].rays[1].range, 4);
  ASSERT_EQ(scans[1].rays.size(), 1u);
  EXPECT_FLOAT_EQ(scans[1].rays[0].bearing, 0.1F);
}

/// A camera 100 m above the middle, looking down, with the top of the image to the north.
PosedImageFile camera_above() {
  PosedImageFile image{.name = "a.png", .path = "", .view = {}};
  image.view.camera = {.columns = 200, .rows = 100, .fx = 100, .fy = 100, .cx = 99.5, .cy = 49.5};
  image.view.grid_from_camera.transform.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  image.view.grid_from_camera.transform.translation() << 20, 30, 100;
  return image;
}

TEST(ViewImages, BorderRaysMeetTheGroundAtTheFootprint) {
  const ViewFrame frame(Crs::local(), LocalFrame(Crs::local(), {}), {20, 30, 0});
  const auto images = make_view_images({camera_above()}, frame);
  ASSERT_EQ(images.size(), 1u);
  ASSERT_EQ(images[0].border.size(), 32u);
  // The upper left corner lies 100 m west and 50 m north of the camera.
  const Eigen::Vector3d ground = images[0].centre + images[0].border[0] * (100 / -images[0].border[0].z());
  EXPECT_NEAR((ground - Eigen::Vector3d(-100, 50, 0)).norm(), 0, 1e-6);
  EXPECT_TRUE(images[0].jpeg.empty());
}

TEST(ViewImages, AxesOfAGridAreTurnedToNorth) {
  // 3 degrees east of the central meridian at 45 N, grid north lies 3 sin 45 = 2.12 degrees west of north.
  const Crs utm = Crs::from_text("EPSG:32632");
  const CrsTransform to_utm(Crs::from_text("EPSG:4326"), utm);
  const auto at = to_utm(12, 45);
  const ViewFrame frame(utm, LocalFrame(utm, {{at.x, at.y, 0}}), {0, 0, 0});
  const Eigen::Matrix3d turn = frame.rotation_from_grid({{at.x, at.y, 0}});
  EXPECT_NEAR(std::atan2(turn(0, 1), turn(1, 1)) * 180 / std::numbers::pi, 2.12, 0.02);
  EXPECT_NEAR(turn.determinant(), 1, 1e-9);
}

TEST(ViewImages, ADamagedCameraRecordIsLeftOut) {
  const TemporaryFolder folder;
  geodb::MapContents map = three_summits("EPSG:4326", -70.05, -32.65, 0.01);
  const std::string sound =
      R"({"model":"brown","columns":200,"rows":100,"focal":[100,100],"principal_point":[99.5,49.5],"skew":0,)"
      R"("distortion":[0,0,0,0,0,0,0,0],"centre":[1,2,3],"grid_from_camera":[[1,0,0],[0,-1,0],[0,0,-1]]})";
  int i = 0;
  for (const std::string& camera :
       {sound, std::string("{}"), std::string(R"({"model":"brown"})"), std::string(R"({"model":7})"),
        std::string(R"({"model":"ortho"})"), std::string("[]")}) {
    geodb::ImageRecord image;
    image.name = "image_" + std::to_string(i++) + ".png";
    image.camera_json = camera;
    map.images.push_back(image);
  }
  geodb::write_map(folder / "map.gpkg", map);
  const auto images = posed_images(geodb::MapStore::open(folder / "map.gpkg"));
  ASSERT_EQ(images.size(), 1u);
  EXPECT_EQ(images[0].view.camera.columns, 200);
}

}  // namespace
}  // namespace waymark::test
