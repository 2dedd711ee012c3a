// SPDX-License-Identifier: Apache-2.0
#include "testbed/scenario.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "core/text_file.hpp"
#include "testbed/landing/flight.hpp"
#include "testbed/scene_files.hpp"

namespace waymark::test {
using namespace testbed;
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string refusal_of_scenario(const std::string& json) {
  try {
    read_scenario(json, "site.json");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    return error.what();
  }
  return "accepted";
}

TEST(Scenario, DefaultsStandForWhatIsNotGiven) {
  const Scenario scenario = read_scenario(R"({"waymark_scenario": 1, "rocks": {"k": 0.2}})", "site.json");
  EXPECT_EQ(scenario.ground.rocks.k, 0.2);
  EXPECT_EQ(scenario.ground.rocks.max_diameter, RockPopulation{}.max_diameter);
  EXPECT_EQ(scenario.flights.size(), 1u);
}

TEST(Scenario, IsReadBackAsWritten) {
  Scenario scenario =
      read_scenario(R"({"waymark_scenario": 1, "seed": 9, "picture": {"photometry": "lambert", "bits": 16},
    "relief": {"mountains": 3}, "flights": [{"name": "a", "tilt": 12}, {"name": "b", "images": 3}]})",
                    "site.json");
  const std::string written = scenario_json(scenario);
  EXPECT_EQ(scenario_json(read_scenario(written, "again")), written);
  EXPECT_THAT(written, HasSubstr("\"photometry\": \"lambert\""));
  EXPECT_THAT(written, HasSubstr("\"mountains\": 3"));
  EXPECT_THAT(written, HasSubstr("\"tilt\": 12.0"));
}

TEST(Scenario, SaysWhereItIsWrong) {
  EXPECT_THAT(refusal_of_scenario("{"),
              StartsWith("not valid JSON: expected a name in double quotes\n  site.json:1:2"));
  EXPECT_THAT(refusal_of_scenario("{}"),
              StartsWith("not a scenario: \"waymark_scenario\" is missing\n  site.json"));
  EXPECT_THAT(refusal_of_scenario(R"({"waymark_scenario": 2})"),
              StartsWith("waymark_scenario is 2, this program reads 1"));
  EXPECT_THAT(refusal_of_scenario(R"({"waymark_scenario": 1, "rocks": {"kk": 1}})"),
              StartsWith("rocks has no option 'kk'; did you mean 'k'?"));
  EXPECT_THAT(refusal_of_scenario(R"({"waymark_scenario": 1, "rock": {}})"),
              StartsWith("the scenario has no option 'rock'; did you mean 'rocks'?"));
  EXPECT_THAT(refusal_of_scenario(R"({"waymark_scenario": 1, "sun": {"elevation": -3}})"),
              StartsWith("sun.elevation = -3 is outside [0.5, 90]"));
  EXPECT_THAT(refusal_of_scenario(R"({"waymark_scenario": 1, "sun": {"elevation": "high"}})"),
              StartsWith("sun.elevation must be a number, is a string (\"high\")"));
  EXPECT_THAT(refusal_of_scenario(R"({"waymark_scenario": 1, "camera": {"rows": 1.5}})"),
              StartsWith("camera.rows must be a whole number, is a number (1.5)"));
  EXPECT_THAT(refusal_of_scenario(R"({"waymark_scenario": 1, "picture": {"bits": 12}})"),
              StartsWith("picture.bits must be 8 or 16, is 12"));
  EXPECT_THAT(refusal_of_scenario(R"({"waymark_scenario": 1, "flights": []})"),
              StartsWith("flights must be a list"));
  EXPECT_THAT(refusal_of_scenario(R"({"waymark_scenario": 1, "flights": [{"images": 0}]})"),
              StartsWith("flights[0].images = 0 is outside"));
  EXPECT_THAT(refusal_of_scenario(R"({"waymark_scenario": 1, "flights": [{}, {}]})"),
              StartsWith("flights[1] and an earlier flight are both called 'descent'"));
}

TEST(Scenario, FormerNamesAreReadWithAWarning) {
  std::vector<std::string> warnings;
  const Scenario scenario = read_scenario(
      R"({"waymark_scenario": 1, "relief": {"longest": 70}, "drive": {"steepest": 0.5, "laser": {"most_range": 9}}})",
      "site.json", [&](const std::string& warning) { warnings.push_back(warning); });
  EXPECT_EQ(scenario.ground.relief.longest, 70);
  EXPECT_EQ(scenario.drive.max_slope, 0.5);
  EXPECT_EQ(scenario.drive.laser.max_range, 9);
  EXPECT_THAT(warnings,
              testing::UnorderedElementsAre("relief.longest was renamed: use max_wavelength (site.json)",
                                            "drive.steepest was renamed: use max_slope (site.json)",
                                            "drive.laser.most_range was renamed: use max_range (site.json)"));
}

TEST(Scenario, TheCommittedSchemaIsUpToDate) {
  EXPECT_EQ(read_text(WAYMARK_SOURCE_DIR "/docs/scenario.schema.json", "the scenario"), scenario_schema())
      << "write scenario_schema() to docs/scenario.schema.json";
}

TEST(Scenario, TheSampleIsOne) {
  const Scenario scenario = read_scenario(
      read_text(WAYMARK_SOURCE_DIR "/sample_data/mars_landing/scenario.json", "the scenario"), "sample");
  EXPECT_GE(scenario.flights.front().images, 8);
}

Scenario small_scenario() {
  return read_scenario(
      R"({"waymark_scenario": 1, "ground": {"cell": 1, "up": 100, "east": 5000, "north": -3000},
    "camera": {"columns": 100, "rows": 80, "k1": -0.05}, "relief": {"rms": 2}, "craters": {"max_diameter": 30},
    "pose_errors": {"position_sd": 0.5, "attitude_sd": 0.1}, "rocks": {"min_diameter": 1.5},
    "flights": [{"images": 4, "from_altitude": 200, "to_altitude": 50, "attitude_sd": 0, "track_sd": 0}]})",
      "small");
}

TEST(Flight, LooksDownWithTheHeadingUp) {
  Scenario scenario = small_scenario();
  scenario.flights.front().from_east = scenario.flights.front().from_north = 0;
  scenario.flights.front().to_east = 0, scenario.flights.front().to_north = 90;  // due north
  const std::vector<Shot> shots = plan_shots(scenario);
  ASSERT_EQ(shots.size(), 4u);
  EXPECT_EQ(shots[1].name, "descent_0002.png");
  EXPECT_NEAR(shots[1].view.centre().xyz.y(), -3000 + 30, 1e-9);
  EXPECT_NEAR(shots[1].view.centre().xyz.z(), 100 + 200 * std::pow(0.25, 1.0 / 3), 1e-9);  // equal factors
  const auto north = project(shots[0].view, {{5000, -3000 + 10, 100}}),
             east = project(shots[0].view, {{5010, -3000, 100}});
  ASSERT_TRUE(north && east);
  EXPECT_NEAR(north->x(), 49.5, 1e-9);
  EXPECT_LT(north->y(), 39.5 - 1);
  EXPECT_GT(east->x(), 49.5 + 1);
}

TEST(Flight, TiltsForwards) {
  Scenario scenario = small_scenario();
  scenario.flights.front().tilt = {20};
  const Shot shot = plan_shots(scenario).front();
  const auto line = ray(shot.view, {49.5, 39.5});
  ASSERT_TRUE(line);
  const Eigen::Vector3d ahead = Eigen::Vector3d(1, 1, 0).normalized();  // from south-west to north-east
  EXPECT_NEAR(line->direction.unit.dot(ahead), std::sin(20 * kRadiansPerDegree), 1e-9);
}

TEST(Flight, ToldPosesHaveTheErrorsAsked) {
  Scenario scenario = small_scenario();
  scenario.flights.front().images = 3000;
  double position = 0, angle = 0;
  for (const Shot& shot : plan_shots(scenario)) {
    const Eigen::Isometry3d off = shot.view.grid_from_camera.transform.inverse() * shot.reported.transform;
    position += off.translation().squaredNorm() / 3;
    angle += std::pow(Eigen::AngleAxisd(off.linear()).angle(), 2) / 3;
  }
  EXPECT_NEAR(std::sqrt(position / 3000), 0.5, 0.02);
  EXPECT_NEAR(std::sqrt(angle / 3000) / kRadiansPerDegree, 0.1, 0.004);
}

TEST(Flight, GroundReachesBeyondEveryFootprint) {
  Scenario scenario = small_scenario();
  const std::vector<Shot> shots = plan_shots(scenario);
  scenario.ground = size_site(scenario, shots);
  EXPECT_NO_THROW(check_footprints(make_scene(scenario.ground, 1), shots));
  scenario.ground.width = 60;
  try {
    check_footprints(make_scene(scenario.ground, 1), shots);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.problem(), "image descent_0001.png extends beyond the terrain");
  }
}

TEST(Flight, RefusesToLookAtTheSky) {
  Scenario scenario = small_scenario();
  scenario.flights.front().tilt = {75};
  try {
    size_site(scenario, plan_shots(scenario));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.problem(), "image descent_0001.png sees the sky: its footprint is unbounded");
  }
}

TEST(SceneFiles, TheTruthOfAnImageLiesWhereTheCameraSeesIt) {
  Scenario scenario = small_scenario();
  const std::vector<Shot> shots = plan_shots(scenario);
  scenario.ground = size_site(scenario, shots);
  const Scene scene = make_scene(scenario.ground, 1);
  const TruthTables truth = truth_tables(scenario, scene, shots);
  EXPECT_THAT(truth.landmarks, StartsWith("type,x,y,z,radius,height,depth,major_axis,minor_axis,orientation,"
                                          "images,pixels,shape,preserved\ncrater,"));
  EXPECT_THAT(truth.landmarks, HasSubstr("\nrock,"));
  EXPECT_THAT(truth.detections,
              StartsWith("image,type,x,y,diameter,major,minor,angle,landmark\ndescent_0001.png,crater,"));
}

TEST(SceneFiles, TheTruthOfARollingShutterMovesWithTheRows) {
  Scenario scenario = small_scenario();
  std::vector<Shot> shots = plan_shots(scenario);
  scenario.ground = size_site(scenario, shots);
  const Scene scene = make_scene(scenario.ground, 1);
  Shot& shot = shots.front();
  constexpr double kReadout = 0.2;
  const Eigen::Matrix3d axes = shot.view.grid_from_camera.transform.linear();
  shot.motion.velocity = 10 * axes.col(0);  // to the right
  const View still = camera_view(shot.view), moving = camera_view(true_camera(shot, kReadout));
  EXPECT_FALSE(true_camera(shot, 0).motion);
  int compared = 0;
  for (const TrueCrater& crater : scene.craters) {
    const auto at = image_outline(still, crater), seen = image_outline(moving, crater);
    if (!at || !seen) continue;
    ++compared;
    const double range = axes.col(2).dot(crater.position - shot.view.centre().xyz);
    const double passed = 10 * kReadout * (at->y / double(shot.view.camera.rows - 1) - 0.5);
    EXPECT_NEAR(seen->x - at->x, -shot.view.camera.fx * passed / range, 0.1);
    EXPECT_NEAR(seen->y, at->y, 0.1);
  }
  EXPECT_GT(compared, 3);
}

TEST(SceneFiles, TheDemIsTheGroundWithItsError) {
  Scenario scenario = small_scenario();
  scenario.dem = {.cell = 2, .height_sd = 0.3, .correlation = 6};
  scenario.ground.width = scenario.ground.height = 301;
  const Scene scene = make_scene(scenario.ground, 1);
  const SimulatedDem dem = simulate_dem(scenario.dem, scene);
  double squares = 0;
  std::int64_t count = 0;
  for (std::int64_t j = 2; j < dem.heights.rows() - 2; ++j)
    for (std::int64_t i = 2; i < dem.heights.columns() - 2; ++i, ++count) {
      const double truth = *scene.terrain.height(dem.x0 + 2 * double(i), dem.y0 - 2 * double(j));
      squares += std::pow(double(dem.heights(i, j)) - truth, 2);
    }
  EXPECT_NEAR(std::sqrt(squares / double(count)), 0.3, 0.08);  // and a little for the smoothing over the cell
}

TEST(SceneFiles, CamerasAreWrittenWithSunAndErrors) {
  const Scenario scenario = small_scenario();
  const std::vector<Shot> shots = plan_shots(scenario);
  const std::string reported = camera_file(scenario, shots, false),
                    exact = camera_file(scenario, shots, true);
  EXPECT_THAT(reported, HasSubstr("\"rotation_sd\": 0.1"));
  EXPECT_THAT(reported, HasSubstr("\"azimuth\": 135.0"));
  EXPECT_THAT(exact, ::testing::Not(HasSubstr("rotation_sd")));
  EXPECT_NE(reported, exact);
}

}  // namespace
}  // namespace waymark::test
