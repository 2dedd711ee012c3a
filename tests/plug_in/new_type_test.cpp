// SPDX-License-Identifier: Apache-2.0
// Types from outside go from detection to localization; no other file of the program knows them.
#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <waymark/waymark.hpp>

#include "tests/plug_in/marks.hpp"
namespace waymark::test {

void register_test_types(TypeRegistry& types);
void register_test_stages(pipeline::Registry& stages);

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kHeight = 30, kFocal = 96, kSide = 96;  // of the camera: metres, pixels
const Eigen::Vector2d kPotholeAt(3, -7);
constexpr double kPotholeRadius = 4.7;

struct Object {
  Mark mark;
  double x, y;     // metres
  int images = 4;  // that show it: the first ones
};

// The haystack and the lamp post west of the pothole stand on its rim, which faces the sun.
const std::vector<Object> kWorld = {{kPothole, 3, -7},     {kHaystack, -4, 8},   {kTallHaystack, 4, 8},
                                    {kHaystack, -1.9, -7}, {kLampPost, -7, -12}, {kLampPost, -2, -5.5},
                                    {kLampPost, 10, 3},    {kLampPost, 0, 12},   {kLampPost, 8, 9, 1}};

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// Four images from above a plain with a bowl, and the map of the objects marked in them.
class NewType : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = std::filesystem::path(testing::TempDir()) / ("new_type_" + std::to_string(getpid()));
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    register_landmark_types(types);
    register_test_types(types);
    workflows::register_built_in_stages(stages);
    register_test_stages(stages);
    write_dem();
    write_images();
    pipeline::Job job = pipeline::parse_job(R"({"name": "marks", "stages": [
      {"stage": "load_dem", "files": ["dem.asc"], "crs": "local"},
      {"stage": "load_images", "cameras": "cameras.json"}, {"stage": "read_marks"},
      {"stage": "project_to_ground", "register_to_dem": false}, {"stage": "reject_implausible"},
      {"stage": "reject_terrain_shadows", "min_drop": 1}, {"stage": "reject_rim_shadows"}, {"stage": "align_images"},
      {"stage": "merge_observations"}, {"stage": "value_landmarks"}]})",
                                            stages);
    job.pipeline.base_folder = folder;
    workflows::make_map(job, {.map = map(), .run = {.types = &types}});
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(folder); }
  static std::string map() { return folder / "map.gpkg"; }

  static void write_dem() {
    std::ofstream dem(folder / "dem.asc");
    dem << "ncols 120\nnrows 120\nxllcorner -60\nyllcorner -60\ncellsize 1\n";
    for (int row = 0; row < 120; ++row)
      for (int column = 0; column < 120; ++column) {
        const double r = std::hypot(column - 59.5 - kPotholeAt.x(), 59.5 - row - kPotholeAt.y());
        dem << 1.5 * std::min(0.0, std::pow(r / kPotholeRadius, 2) - 1) << (column == 119 ? '\n' : ' ');
      }
  }
  static void write_images() {
    std::string list;
    for (int i = 0; i < 4; ++i) {
      const double east = 2 * i;
      std::string pixels(static_cast<std::size_t>(kSide * kSide), 'x');
      for (const Object& object : kWorld) {
        const double scale = kFocal / kHeight, middle = (kSide - 1) / 2;
        const auto column = std::lround(middle + scale * (object.x - east)),
                   row = std::lround(middle - scale * object.y);
        if (i < object.images)
          pixels.at(static_cast<std::size_t>(row * static_cast<long>(kSide) + column)) =
              static_cast<char>(object.mark.value);
      }
      const std::string name = "image_" + std::to_string(i) + ".pgm";
      std::ofstream(folder / name) << "P5 96 96 255\n" << pixels;
      list += (i ? "," : "") + std::string(R"({"camera": "k", "rotation_sd": 0.001, "position_sd": 0.01,
          "rotation": [[1, 0, 0], [0, -1, 0], [0, 0, -1]], "name": ")") +
              name + R"(", "centre": [)" + std::to_string(east) + ", 0, 30]}";
    }
    std::ofstream(folder / "cameras.json") << R"({"waymark_cameras": 1, "frame": {"axes": "grid",
        "crs": "local"}, "sun": {"azimuth": 270, "elevation": 35}, "cameras": {"k": {"columns": 96,
        "rows": 96, "fx": 96, "fy": 96, "cx": 47.5, "cy": 47.5}}, "images": [)"
                                           << list << "]}";
  }

  /// Returns the reasons for which observations near a place were rejected.
  static std::set<std::string> rejections_at(double x, double y) {
    std::set<std::string> reasons;
    geodb::MapStore::open(map()).visit_observations([&](Observation&& o) {
      if (std::hypot(o.position.xyz.x() - x, o.position.xyz.y() - y) < 1) reasons.insert(o.rejected);
    });
    return reasons;
  }

  static inline std::filesystem::path folder;
  static inline TypeRegistry types;
  static inline pipeline::Registry stages;
};

TEST_F(NewType, IsMapped) {
  const geodb::MapStore store = geodb::MapStore::open(map());
  EXPECT_EQ(store.count("lamp_post"), 4);
  EXPECT_EQ(store.count("haystack"), 1);
  EXPECT_EQ(store.count("pothole"), 1);
  EXPECT_THAT(geodb::validate_map(map()), IsEmpty());
  for (const Landmark& post : store.query({.types = {"lamp_post"}})) {
    EXPECT_EQ(post.quality.seen, 4);
    EXPECT_NEAR(post.features[0].value, 0.31, 0.05);
    EXPECT_GT(post.confidence, 0.9);
  }
}

// Height over diameter 4: the bounds of a shadow caster do not hold for a pole.
TEST_F(NewType, DecidesThePhysicsByItsEvidenceModel) {
  EXPECT_THAT(rejections_at(4, 8), ElementsAre("too tall"));
  EXPECT_THAT(rejections_at(-1.9, -7), ElementsAre("shadow of a crater's rim"));
  for (const Object& object : kWorld) {
    if (std::string(object.mark.type) != "lamp_post" || object.images < 4) continue;
    EXPECT_THAT(rejections_at(object.x, object.y), ElementsAre("")) << object.x << ' ' << object.y;
  }
  const auto holes = geodb::MapStore::open(map()).query({.types = {"pothole"}});
  ASSERT_EQ(holes.size(), 1u);
  EXPECT_NEAR(holes[0].features[0].value, 2 * kPotholeRadius, 2);
  EXPECT_NEAR(holes[0].features[1].value, 1.5, 0.8);
}

TEST_F(NewType, IsValuedByItsOwnWeights) {
  EXPECT_THAT(rejections_at(8, 9), ElementsAre("landmark improbable"));
}

TEST_F(NewType, IsStoredInTheMap) {
  const LandmarkType read = *geodb::MapStore::open(map()).types().find("lamp_post");
  const LandmarkType& wanted = *types.find("lamp_post");
  EXPECT_EQ(read.evidence, wanted.evidence);
  EXPECT_EQ(read.body, wanted.body);
  EXPECT_EQ(read.identification_reach, wanted.identification_reach);
  EXPECT_EQ(read.identifies_itself, wanted.identifies_itself);
}

TEST_F(NewType, IsReported) {
  exporters::write_report(map(), folder / "report.html");
  const std::string report = text_of(folder / "report.html");
  for (const char* title : {"Lamp post", "Haystack", "Pothole"}) EXPECT_THAT(report, HasSubstr(title));
}

// Bearings from 250 m, beyond the reach of a rock.
TEST_F(NewType, LocalizesARobotByBearings) {
  const Eigen::Vector2d robot(-250, 40);
  const double yaw = 0.1;
  std::ofstream log(folder / "drive.jsonl");
  log << R"({"kind":"header","version":1,"frame":"crs"})" << '\n';
  for (int i = 0; i < 10; ++i) {
    log << R"({"kind":"step","t":)" << i << R"(,"dx":0,"dy":0,"dyaw":0})" << '\n';
    log << R"({"kind":"sightings","t":)" << i + 0.5 << R"(,"items":[)";
    bool first = true;
    for (const Object& object : kWorld) {
      if (std::string(object.mark.type) != "lamp_post" || object.images < 4) continue;
      const double bearing = std::atan2(object.y - robot.y(), object.x - robot.x()) - yaw;
      log << (first ? "" : ",") << R"({"type":"lamp_post","bearing_sd":0.003,"bearing":)" << bearing << '}';
      first = false;
    }
    log << "]}\n";
  }
  log.close();
  for (const char* method : {"ekf", "ukf", "pf"}) {
    const workflows::LocalizeResult result = workflows::localize({.map = map(),
                                                                  .log = folder / "drive.jsonl",
                                                                  .method = method,
                                                                  .use_identities = false,
                                                                  .start = "-249.9,40.1,0.08"});
    EXPECT_GT(result.track.verdicts[static_cast<std::size_t>(localization::Verdict::matched)], 30) << method;
    ASSERT_FALSE(result.track.rows.empty());
    EXPECT_LT(std::abs(result.track.rows.back().at.pose.yaw - yaw), 0.015) << method;
  }
}

}  // namespace
}  // namespace waymark::test
