// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/error.hpp"
#include "geo/axes_rotation.hpp"
#include "importers/logs/import_log.hpp"
#include "localization/detectors/laser_stems.hpp"
#include "localization/filters/kalman.hpp"
#include "localization/filters/multi_hypothesis_filter.hpp"
#include "localization/filters/particle_filter.hpp"
#include "localization/replay_log.hpp"
#include "localization/robot_log.hpp"
#include "localization/slam/ekf_slam.hpp"
#include "localization/track_score.hpp"
#include "tests/localization/mrclam_robots.hpp"
#include "tests/support/message_of.hpp"

namespace waymark::test {
using namespace localization;
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TypeRegistry all_types() {
  TypeRegistry types;
  register_landmark_types(types);
  return types;
}

class WaymarkLog : public ::testing::Test {
 protected:
  RobotLog read(const std::string& text) {
    std::ofstream(file_) << text;
    return importers::import_log(file_, all_types());
  }
  std::string refusal(const std::string& text) {
    return message_of([&] { read(text); });
  }
  void TearDown() override { fs::remove(file_); }
  fs::path file_ = fs::temp_directory_path() / ("waymark_log_" + std::to_string(getpid()) + ".jsonl");
};

TEST_F(WaymarkLog, HoldsAllSensors) {
  const RobotLog log = read(
      R"({"kind":"header","version":1,"frame":"map","start":{"x":1,"y":2,"yaw":0.5}}
{"kind":"truth","t":0,"x":1,"y":2,"yaw":0.5}
{"kind":"odometry","t":0,"v":1,"omega":0.1}

{"kind":"sightings","t":0.5,"mount":{"x":0.3,"y":0},"items":[{"type":"rock","range":4,"bearing":-0.2,"landmark":"rk-1","features":{"radius":{"value":0.4,"sd":0.05}}},{"bearing":1}]}
{"kind":"laser","t":0.6,"first_angle":-1.57,"angle_step":0.1,"ranges":[1,null,3],"intensities":[9,null,7]}
{"kind":"gnss","t":0.7,"x":1,"y":2,"sd":3}
{"kind":"car","t":0.8,"v":1,"steering":0.1}
{"kind":"step","t":0.9,"dx":1,"dy":0,"dyaw":0.1}
{"kind":"sonar","t":1}
)");
  ASSERT_EQ(log.events.size(), 6u);
  EXPECT_EQ(log.truth.size(), 1u);
  EXPECT_EQ(log.start, (Pose2{1, 2, 0.5}));
  const auto& seen = std::get<SightingSet>(log.events[1].what);
  EXPECT_EQ(seen.robot_from_sensor.x, 0.3);
  EXPECT_EQ(seen.sightings[0].identity, landmark_key("rk-1"));
  EXPECT_EQ(seen.sightings[0].features.value[0], 0.4);
  EXPECT_DOUBLE_EQ(seen.sightings[0].features.variance[0], 0.0025);
  EXPECT_FALSE(seen.sightings[1].range);
  EXPECT_THAT(std::get<LaserScan>(log.events[2].what).intensities, ElementsAre(9, 0, 7));
  EXPECT_THAT(log.remarks, ElementsAre(HasSubstr("1 records of the kind 'sonar'")));
}

TEST_F(WaymarkLog, ASightingOfALineHasARangeAndAnExtent) {
  const RobotLog log = read(
      R"({"kind":"sightings","t":0,"items":[{"type":"wall","range":4,"extent":[-2,3.5],"features":{"direction":1.5}}]})");
  const SeenLandmark& s = std::get<SightingSet>(log.events.at(0).what).sightings.at(0);
  EXPECT_EQ(s.extent->from, -2);
  EXPECT_EQ(s.extent->to, 3.5);
  const auto refused = [&](const std::string& item) {
    return message_of([&] { read(R"({"kind":"sightings","t":0,"items":[{)" + item + "}]}"); });
  };
  EXPECT_THAT(refused(R"("range":4,"extent":[3,2])"), HasSubstr("the smaller one first"));
  EXPECT_THAT(refused(R"("range":4,"extent":[3])"), HasSubstr("two numbers"));
  EXPECT_THAT(refused(R"("range":4,"bearing":1,"extent":[3,4])"), HasSubstr("excludes"));
}

TEST_F(WaymarkLog, ASightingIsABearingARangeOrBoth) {
  const RobotLog log = read(
      R"({"kind":"sightings","t":0,"items":[{"range":4,"landmark":"N"},{"bearing":1},{"range":4,"bearing":null},{"range":4,"bearing":1}]})"
      "\n");
  const auto& seen = std::get<SightingSet>(log.events.at(0).what).sightings;
  ASSERT_EQ(seen.size(), 4U);
  EXPECT_EQ(seen[0].bearing, std::nullopt);
  EXPECT_EQ(seen[0].range, 4);
  EXPECT_NEAR(seen[0].range_sd, 0.13, 1e-12);
  EXPECT_EQ(seen[0].identity, landmark_key("N"));
  EXPECT_EQ(seen[1].range, std::nullopt);
  EXPECT_EQ(seen[2].bearing, std::nullopt);
  for (const SeenLandmark& s : seen) EXPECT_TRUE(s.is_valid());
  EXPECT_TRUE(seen[3].has_position());
  EXPECT_THAT(refusal(R"({"kind":"sightings","t":0,"items":[{"landmark":"N"}]})"),
              HasSubstr("neither \"bearing\" nor \"range\""));
  EXPECT_THAT(refusal(R"({"kind":"sightings","t":0,"items":[{"range":4,"elevation":0.1}]})"),
              HasSubstr("has an \"elevation\" without \"bearing\""));
}

TEST_F(WaymarkLog, StatesTheNoiseOfItsOdometryAndSensors) {
  const std::string drive = R"(
{"kind":"odometry","t":0,"v":1,"omega":0}
{"kind":"sightings","t":1,"items":[{"range":4,"bearing":0},{"range":4,"bearing":0,"range_sd":0.2,"bearing_sd":0.1}]}
)";
  const RobotLog log = read(R"({"kind":"header","range_sd":0.5,"bearing_sd":0.03,)"
                            R"("odometry_noise":{"yaw_per_metre":1e-6,"scale_sd":0.02}})" +
                            drive);
  ASSERT_TRUE(log.odometry);
  EXPECT_EQ(log.odometry->yaw_per_metre, 1e-6);
  EXPECT_EQ(log.odometry->along_per_metre, OdometryNoise{}.along_per_metre);
  EXPECT_EQ(log.drift, (OdometryDrift{.scale_sd = 0.02}));
  const auto& seen = std::get<SightingSet>(log.events[1].what).sightings;
  EXPECT_EQ(seen[0].range_sd, 0.5);
  EXPECT_EQ(seen[0].bearing_sd, 0.03);
  EXPECT_EQ(seen[1].range_sd, 0.2);
  EXPECT_EQ(seen[1].bearing_sd, 0.1);
  EXPECT_FALSE(read(drive).odometry);
  EXPECT_FALSE(read(drive).drift.any());

  const auto header = [](const std::string& noise) {
    return R"({"kind":"header","odometry_noise":{)" + noise + "}}";
  };
  EXPECT_THAT(refusal(header(R"("yaw_per_meter":1)")),
              AllOf(HasSubstr("unknown \"yaw_per_meter\" in \"odometry_noise\""), HasSubstr("line 1")));
  EXPECT_THAT(refusal(header(R"("yaw_per_metre":-1)")), HasSubstr("yaw_per_metre = -1 is not at least 0"));
  EXPECT_THAT(refusal(header(R"("scale_sd":3)")), HasSubstr("scale_sd = 3 is outside [0, 0.5]"));
  EXPECT_THAT(refusal(header(R"("drift_distance":0)")),
              HasSubstr("drift_distance = 0 is outside [0.1, 1000000]"));
}

TEST_F(WaymarkLog, AFixHasADeviationOrACovariance) {
  RobotLog log = read(R"({"kind":"header","frame":"crs","start":{"x":700000,"y":0,"yaw":0}}
{"kind":"gnss","t":0,"x":700000,"y":0,"var_x":4.67,"var_y":6.05}
{"kind":"gnss","t":1,"x":700000,"y":5000000,"var_x":5,"var_y":5,"cov_xy":-4}
)");
  ASSERT_EQ(log.events.size(), 2U);
  const auto& plain = std::get<GnssFix>(log.events[0].what);
  EXPECT_NEAR(plain.sd, std::sqrt(6.05), 1e-12);
  EXPECT_EQ(plain.noise(), (Eigen::Matrix2d() << 4.67, 0, 0, 6.05).finished());
  EXPECT_NEAR(std::get<GnssFix>(log.events[1].what).sd, 3, 1e-12);
  // The map frame is turned against the grid by the convergence: 2.6 degrees in the north-east of a zone.
  const LocalFrame frame(Crs::from_text("EPSG:32633"), {{700000, 6500000, 0}});
  log.start = Pose2{700000, 6500000, 0};
  const double angle = -grid_rotation(frame, {0, 0});
  ASSERT_GT(std::abs(angle), 0.02);
  convert_to_map_frame(log, frame);
  const Eigen::Matrix2d axes = Eigen::Rotation2Dd(angle).toRotationMatrix();
  const Eigen::Matrix2d turned = axes * Eigen::Vector2d(4.67, 6.05).asDiagonal() * axes.transpose();
  EXPECT_LT((std::get<GnssFix>(log.events[0].what).noise() - turned).norm(), 1e-9);

  const std::string fix = R"({"kind":"gnss","t":0,"x":1,"y":2,)";
  EXPECT_THAT(refusal(fix + R"("sd":1,"var_x":1,"var_y":1})"), HasSubstr("one of both is needed"));
  EXPECT_THAT(refusal(fix + R"("var_x":1})"), HasSubstr("has no \"var_y\""));
  EXPECT_THAT(refusal(fix + R"("var_x":1,"var_y":-1})"), HasSubstr("are no covariance"));
  EXPECT_THAT(refusal(fix + R"("var_x":1,"var_y":1,"cov_xy":1})"), HasSubstr("are no covariance"));
}

TEST_F(WaymarkLog, SaysWhatIsWrongAndWhere) {
  const std::string ok = R"({"kind":"odometry","t":0,"v":1,"omega":0})"
                         "\n";
  EXPECT_THAT(refusal(""), HasSubstr("the log is empty"));
  EXPECT_THAT(refusal(ok + "nonsense\n"), AllOf(HasSubstr("no JSON object"), HasSubstr("line 2")));
  EXPECT_THAT(refusal(ok + R"({"kind":"odometry","t":NaN,"v":1,"omega":0})"), HasSubstr("no JSON object"));
  EXPECT_THAT(refusal(R"({"kind":"odometry","t":0,"omega":0})"), HasSubstr("has no \"v\""));
  EXPECT_THAT(refusal(R"({"kind":"odometry","t":"0","v":1,"omega":0})"), HasSubstr("\"t\" must be a number"));
  EXPECT_THAT(refusal(R"({"kind":"sightings","t":0,"items":[{"bearing":35}]})"),
              HasSubstr("\"bearing\" is 35: angles are radians"));
  EXPECT_THAT(refusal(R"({"kind":"sightings","t":0,"items":[{"bearing":0,"range_sd":-1}]})"),
              HasSubstr("\"range_sd\" must be above 0"));
  EXPECT_THAT(
      refusal(
          R"({"kind":"sightings","t":0,"items":[{"type":"tree","bearing":0,"features":{"diameter":-0.3}}]})"),
      HasSubstr("\"diameter\" must be above 0, is -0.3"));
  EXPECT_THAT(
      refusal(R"({"kind":"sightings","t":0,"items":[{"type":"tree","bearing":0,"features":{"radius":1}}]})"),
      HasSubstr("the feature \"radius\", which the type tree has not"));
  EXPECT_THAT(refusal(R"({"kind":"header","version":2})"), HasSubstr("is of version 2"));
  EXPECT_THAT(refusal(R"({"kind":"header","frame":"utm"})"), HasSubstr("must be \"map\" or \"crs\""));
}

TEST_F(WaymarkLog, AWildTimeStampIsRefusedWithItsNumber) {
  const auto odometry = [](const char* t) {
    return std::string(R"({"kind":"odometry","v":1,"omega":0,"t":)") + t + "}\n";
  };
  EXPECT_THAT(refusal(odometry("0") + odometry("1.5") + odometry("1e18")),
              AllOf(HasSubstr("after 1.5 s, the next reading is at 1e+18 s"), HasSubstr(".jsonl")));
  EXPECT_THAT(refusal(odometry("-1e300") + odometry("2")), HasSubstr("after -1e+300 s"));
  EXPECT_THAT(refusal(odometry("1") + odometry("2") +
                      R"({"kind":"truth","t":1,"x":0,"y":0})"
                      "\n" +
                      R"({"kind":"truth","t":1e9,"x":0,"y":0})"
                      "\n"),
              HasSubstr("the next true pose is at 1000000000 s"));
  EXPECT_EQ(read(odometry("0") + odometry("900000")).events.size(), 2U) << "ten days of pause are a pause";
}

TEST_F(WaymarkLog, ADepthImageHasAWholeNumberOfPixels) {
  for (const char* columns : {"1e300", "2.5", "1e6"})
    EXPECT_THAT(refusal(std::string(R"({"kind":"depth","t":0,"rows":1,"focal":9,"depths":[1],"columns":)") +
                        columns + "}"),
                HasSubstr("\"columns\" must be a whole number up to 100000"));
}

TEST_F(WaymarkLog, TimeThatRunsBackwardsIsSortedAndReported) {
  const RobotLog log = read(R"({"kind":"odometry","t":5,"v":1,"omega":0}
{"kind":"odometry","t":1,"v":2,"omega":0}
{"kind":"odometry","t":1,"v":3,"omega":0}
)");
  EXPECT_EQ(log.events.front().t, 1);
  EXPECT_THAT(
      log.remarks,
      ElementsAre(HasSubstr("1 times run backwards"), HasSubstr("1 odometry readings repeat the time"),
                  HasSubstr("1 gaps of more than 1 s in the odometry, the longest 4.0 s")));
}

TEST_F(WaymarkLog, TypesTheMapLacksAreRejectedNotMatched) {
  const RobotLog log =
      read(R"({"kind":"sightings","t":0,"items":[{"type":"boulder","bearing":0,"range":3}]})");
  EXPECT_THAT(log.remarks, ElementsAre(HasSubstr("type 'boulder', which the map does not have")));
  MapLandmark landmark;
  landmark.at = {3, 0};
  ExtendedKalman filter(
      {}, LandmarkMatcher(LandmarkWindow{LandmarkGrid({landmark})}, FeatureScales(all_types())));
  const Track track = replay(log, filter, {});
  EXPECT_EQ(track.verdicts[static_cast<std::size_t>(Verdict::unknown_type)], 1);
}

TEST(ReplayLog, ASpeedHoldsNoLongerThanItMay) {
  RobotLog log;
  log.events.push_back({0, TwistReading{1, 0, 0}});
  log.events.push_back({10, TwistReading{0, 0, 0}});
  DeadReckoning robot({});
  ReplayOptions options;
  options.max_hold = 2;
  const Track track = replay(log, robot, options);
  EXPECT_DOUBLE_EQ(track.rows.back().at.pose.x, 2);
}

// The first step of a log has no step before it: it did not last since the epoch.
TEST(Replay, StampsOfAnEpochDoNotWidenTheFirstStep) {
  RobotLog log;
  log.events.push_back({976052890.0, StepReading{{0.1, 0, 0}}});
  log.events.push_back({976052890.5, StepReading{{0.1, 0, 0}}});
  DeadReckoning robot({});
  const Track track = replay(log, robot, {});
  EXPECT_NEAR(track.rows.back().at.pose.x, 0.2, 1e-9);
  EXPECT_LT(std::sqrt(track.rows.back().at.covariance(0, 0)), 0.1);
}

TEST(LaserStems, FindsAPostBeforeTheBackground) {
  LaserScan scan{.robot_from_sensor = {},
                 .first_angle = -1.5,
                 .angle_step = 0.01,
                 .ranges = std::vector<float>(301, 81.0F),
                 .max_range = 80};
  for (const std::size_t i : {150, 151, 152, 153, 154}) scan.ranges[i] = 10;  // seen under 0.05 rad
  for (std::size_t i = 200; i < 240; ++i) scan.ranges[i] = 12;                // a wall of 4.8 m
  const auto stems = find_stems(scan, {});
  ASSERT_EQ(stems.size(), 1u);
  EXPECT_NEAR(stems[0].bearing, 0.02, 1e-9);
  EXPECT_NEAR(stems[0].range, 10.25, 0.01);
  // A circle between two tangents 0.05 rad apart, its nearest point at 10 m.
  EXPECT_NEAR(stems[0].diameter, 2 * 10 * std::sin(0.025) / (1 - std::sin(0.025)), 1e-3);
  EXPECT_TRUE(find_stems({}, {}).empty());
}

class Mrclam : public ::testing::Test {
 protected:
  void SetUp() override { SKIP_WITHOUT_MRCLAM(); }
  struct Pooled {
    double rmse = 0, heading = 0, anees = 0;
    std::vector<double> medians;
    std::int64_t named = 0, wrong = 0;
  };
  template <class Make>
  Pooled follow(bool identities, Make&& make) {
    const MrclamRobots robots = read_mrclam();
    IdentificationOptions options;
    options.use_identities = identities;
    Pooled all;
    double rows = 0;
    for (std::size_t robot = 0; robot < 5; ++robot) {
      const RobotLog& log = robots.logs[robot];
      const auto localizer = make(
          robots.start[robot],
          LandmarkMatcher(LandmarkWindow{LandmarkGrid(robots.map)}, FeatureScales(robots.types), options));
      const Track track = replay(log, *localizer, {});
      const TrackScore s = score(track, log.truth, TrackAlignment::none, true);
      const auto n = static_cast<double>(s.poses);
      all.rmse += n * s.ate_rmse * s.ate_rmse;
      all.heading += n * *s.heading_rmse_deg * *s.heading_rmse_deg;
      all.anees += n * s.consistency->anees;
      all.medians.push_back(s.ate_median);
      all.named += track.named;
      all.wrong += track.wrong;
      rows += n;
    }
    all.anees /= rows;
    all.rmse = std::sqrt(all.rmse / rows);
    all.heading = std::sqrt(all.heading / rows);
    return all;
  }
};

TEST_F(Mrclam, ExtendedKalmanWithIdentities) {
  const Pooled all = follow(true, [](auto&&... given) { return std::make_unique<ExtendedKalman>(given...); });
  EXPECT_LE(all.rmse, 0.25);
  EXPECT_LE(all.heading, 6.6);
}

TEST_F(Mrclam, UnscentedKalmanWithIdentities) {
  const Pooled all =
      follow(true, [](auto&&... given) { return std::make_unique<UnscentedKalman>(given...); });
  EXPECT_LE(all.rmse, 0.25);
}

TEST_F(Mrclam, HypothesesWithoutIdentities) {
  const Pooled all =
      follow(false, [](auto&&... given) { return std::make_unique<MultiHypothesisFilter>(given...); });
  EXPECT_LE(all.rmse, 0.35);
  EXPECT_GT(all.named, 5000);
  EXPECT_LT(static_cast<double>(all.wrong), 0.05 * static_cast<double>(all.named));
}

// One Gaussian can identify a tenth of these sightings; the sum of Gaussians that follows the robot in the
// map knows more, and SLAM takes its pose where it does.
TEST_F(Mrclam, SlamInTheMapErrsAsTheHypothesesDo) {
  const MrclamRobots robots = read_mrclam();
  IdentificationOptions unnamed;
  unnamed.use_identities = false;
  for (std::size_t robot = 0; robot < 5; ++robot) {
    const auto rmse_of = [&](Localizer& localizer) {
      const RobotLog& log = robots.logs[robot];
      return score(replay(log, localizer, {}), log.truth, TrackAlignment::none, true).ate_rmse;
    };
    const FeatureScales scales(robots.types);
    MultiHypothesisFilter filter(robots.start[robot],
                                 LandmarkMatcher(LandmarkWindow{LandmarkGrid(robots.map)}, scales, unnamed));
    SlamOptions options;
    options.identification = unnamed;
    EkfSlam slam(robots.start[robot], LandmarkGrid(robots.map), scales, options);
    slam.set_pose_finder([](auto&&...) { return PoseSearchResult{}; });
    const double filtered = rmse_of(filter), mapped = rmse_of(slam);
    EXPECT_LT(mapped, std::max(0.25, 1.5 * filtered)) << "robot " << robot + 1;
    std::cout << "robot " << robot + 1 << ": " << filtered << " and " << mapped << " m\n";
  }
}

TEST_F(Mrclam, ParticlesWithIdentities) {
  const Pooled all = follow(true, [](auto&&... given) { return std::make_unique<ParticleFilter>(given...); });
  EXPECT_LE(all.rmse, 0.35);
  EXPECT_LT(all.anees, 1.1);  // of a consistent filter, with 97.5 %: see track_score_test
}

TEST_F(Mrclam, ParticlesFromNowhereWithoutIdentities) {
  const Pooled all = follow(false, [](const PoseEstimate&, auto&&... given) {
    return std::make_unique<ParticleFilter>(std::nullopt, given...);
  });
  for (const double median : all.medians) EXPECT_LT(median, 0.5);
}

}  // namespace
}  // namespace waymark::test
