// SPDX-License-Identifier: Apache-2.0
// Excerpts of the reference of waymark/localization.hpp.
#include <fstream>
#include <iostream>
#include <waymark/localization.hpp>
#include <waymark/map.hpp>
#include <waymark/testbed.hpp>
using namespace waymark;

namespace {

//! [map]
/// Three rocks in metres of the map frame.
SemanticMap rock_map() {
  TypeRegistry types;
  register_landmark_types(types);
  std::vector<Landmark> rocks(3);
  rocks[0].uid = "a", rocks[0].position = {{8, 2, 0}};
  rocks[1].uid = "b", rocks[1].position = {{10, -3, 0}};
  rocks[2].uid = "c", rocks[2].position = {{15, 1, 0}};
  for (Landmark& rock : rocks) rock.type = types.id("rock");
  return SemanticMap(types, Crs::local(), rocks, Point<MapCrs>{});
}
//! [map]

//! [sighting]
/// Rock a as seen from the origin: range in metres, bearing in radians to the left.
localization::SightingSet see_a() {
  localization::SeenLandmark a;
  a.identity = localization::landmark_key("a");
  a.range = std::hypot(8, 2), a.range_sd = 0.05;
  a.bearing = std::atan2(2, 8), a.bearing_sd = 0.01;
  localization::SightingSet seen;
  seen.sightings = {a};
  return seen;
}
//! [sighting]

void see_without_a_bearing_or_a_type() {
  //! [open_sighting]
  localization::SeenLandmark beacon = see_a().sightings[0];
  beacon.bearing.reset();  // a radio measures a range alone
  std::cout << (beacon.has_position() ? "position\n" : "ring\n");
  localization::SeenLandmark trunk;  // a tree (type 1) or a pole (type 4)
  trunk.possible_types = {{.type = 1, .features = {}}, {.type = 4, .features = {}}};
  for (const TypeId type : types_of(trunk)) std::cout << "may be of type " << type << '\n';
  localization::SeenLandmark wall;  // 4 m away, seen from 2 m right to 5 m left of its nearest point
  wall.range = 4, wall.extent = localization::LineExtent{-2, 5};
  std::cout << (wall.is_valid() ? "line\n" : "unsound\n");
  std::cout << (may_share_type(trunk, beacon) ? "perhaps the same\n" : "not the same\n");
  //! [open_sighting]
}

void follow(localization::Localizer& filter) {
  //! [filter]
  filter.predict(
      localization::twist_motion(0.5, 0, 0.1, 0, {}));  // m/s forward, m/s left, rad/s, s: stands still
  for (const localization::Match& match : filter.update(see_a()))
    std::cout << localization::wording(match.verdict) << '\n';
  if (filter.status() == localization::LocalizationStatus::lost) std::cout << "lost\n";
  const localization::PoseEstimate now = filter.estimate();
  std::cout << now.pose.at().transpose() << " m, +- " << std::sqrt(now.covariance(0, 0)) << " m\n";
  //! [filter]
}

void filters() {
  //! [filters]
  const SemanticMap map = rock_map();
  const localization::LandmarkGrid rocks(localization::to_map_landmarks(map));
  const localization::PoseEstimate start{{0.2, -0.1, 0.02},
                                         Eigen::Vector3d(0.1, 0.1, 0.01).asDiagonal()};  // m2, m2, rad2
  const localization::LandmarkMatcher matcher(localization::LandmarkWindow(rocks),
                                              localization::FeatureScales(map.types()));
  localization::ExtendedKalman ekf(start, matcher, localization::KalmanOptions{.lost_after = 20});
  localization::UnscentedKalman ukf(start, matcher);
  localization::ParticleFilter particles(start, matcher);
  localization::DeadReckoning odometry(start);
  //! [filters]
  for (localization::Localizer* filter :
       {static_cast<localization::Localizer*>(&ekf), static_cast<localization::Localizer*>(&ukf),
        static_cast<localization::Localizer*>(&particles), static_cast<localization::Localizer*>(&odometry)})
    follow(*filter);
}

void move() {
  //! [motion]
  const localization::OdometryNoise noise{.along_per_metre = 0.001};  // m2 per metre driven
  const localization::Ackermann car{.wheelbase = 2.5};
  const localization::BodyMotion steered = ackermann_motion(car, 3, 0.1, 0.5, noise);  // m/s, rad, s
  const localization::BodyMotion measured = step_motion(localization::Pose2(1.5, 0, 0.05), 0.5, noise);
  //! [motion]
  //! [step]
  localization::PoseEstimate robot{{0, 0, 0}, Eigen::Vector3d(0.1, 0.1, 0.01).asDiagonal()};
  robot = predict_pose(robot, steered);
  robot = ukf_predict(robot, measured);  // by the unscented transform
  localization::MapLandmark rock;
  rock.key = localization::landmark_key("a"), rock.at = {8, 2};                  // metres
  robot = ekf_update(robot, see_a().sightings[0], localization::Pose2(), rock);  // the sensor is at the robot
  std::cout << localization::clamp_sd(robot.covariance.diagonal().cwiseSqrt()).transpose() << '\n';
  //! [step]
}

void find_anywhere() {
  //! [constellation]
  const SemanticMap map = rock_map();
  const localization::ConstellationIndex index(localization::to_map_landmarks(map),
                                               localization::FeatureScales(map.types()));
  const localization::ConstellationAnswer answer = index.find(see_a());
  if (!answer.fix) std::cout << "no fix: " << answer.reason << '\n';
  //! [constellation]
  //! [body]
  std::vector<localization::LandmarkPosition> positions;  // the same on the Moon, near its north pole
  for (const Landmark& rock : map.landmarks()) {
    const Eigen::Vector3d at = Eigen::Vector3d(rock.position.xyz.x(), rock.position.xyz.y(), 1737400);
    positions.push_back({.at = at, .up = at.normalized()});
  }
  localization::ConstellationOptions options;
  options.false_alarms = 1e-6;
  const localization::ConstellationIndex around(localization::to_map_landmarks(map), positions,
                                                localization::FeatureScales(map.types()), options);
  std::cout << around.triangles() << " triangles\n";
  //! [body]
}

void find_by_summits() {
  //! [skyline]
  const localization::TerrainHeight ground = [](const Eigen::Vector2d& at) {
    return 50 * std::sin(at.x() / 300);
  };                                                    // metres
  const std::vector<localization::HorizonTop> tops(2);  // bearings and elevations of tops, radians
  localization::SkylineOptions options;
  options.eye = 1.5;  // metres above the ground
  const localization::SkylineAnswer answer =
      localization::find_by_skyline(tops, std::vector<localization::SkylineSummit>(2), ground, options);
  if (!answer.fix) std::cout << "no fix: " << answer.reason << '\n';
  //! [skyline]
  //! [resection]
  const std::vector<localization::SkylineSummit> summits{{.at = {9000, 100}, .height = 900},
                                                         {.at = {100, 8000}, .height = 700},
                                                         {.at = {-7000, 0}, .height = 800}};
  std::vector<localization::HorizonTop> seen(3);  // from (100, 100), looking east
  for (std::size_t i = 0; i < seen.size(); ++i)
    seen[i].bearing = std::atan2(summits[i].at.y() - 100, summits[i].at.x() - 100);
  const std::vector<std::optional<std::uint32_t>> matches{0, 1, 2};  // which summit each top is
  const localization::PoseEstimate near{{150, 80, 0.02}, Eigen::Matrix3d::Identity()};
  if (const auto pose = localization::resection(seen, summits, matches, near, ground, {}))
    std::cout << pose->pose.at().transpose() << " m\n";
  const bool visible = localization::clears_terrain({100, 100, 60}, {9000, 100, 900}, ground, {}, 50, 100);
  std::cout << (visible ? "in sight\n" : "hidden\n");
  //! [resection]
}

void localize_log() {
  std::ofstream("drive.json")
      << R"({"waymark_scenario": 1, "crs": "local", "seed": 11, "ground": {"cell": 0.5},
    "rocks": {"k": 0.16, "min_diameter": 0.5, "max_diameter": 4}, "camera": {"columns": 200, "rows": 200},
    "flights": [{"name": "view", "images": 1, "from_altitude": 150, "to_altitude": 150}],
    "drive": {"vehicle": "rover", "length": 60, "laser": {"every": 2, "step": 0.5}}})";
  workflows::simulate({.scenario = "drive.json", .folder = "site"});
  workflows::ImportRequest map{.table = "site/truth/landmarks.csv", .map = "site.gpkg"};
  map.options.map_crs = "local";
  workflows::import_landmarks(map);
  //! [localize]
  workflows::LocalizeRequest request{.map = "site.gpkg",
                                     .log = "site/log.jsonl"};  // as `waymark localize ...`
  request.output = "track.csv";
  request.method = "ekf";
  request.start = "truth";
  std::cout << workflows::localize(request).track.rows.size() << " poses\n";
  const localization::TrackScore score =
      workflows::evaluate(workflows::TrackEvaluation{.track = "track.csv", .truth = "site/log.jsonl"});
  std::cout << score.ate_rmse << " m\n";
  //! [localize]
  //! [methods]
  for (const std::string& method : workflows::localize_methods()) std::cout << method << ' ';
  std::cout << workflows::describe_localize_methods() << '\n'
            << workflows::localize_settings(request) << workflows::localize_settings_json(request) << '\n';
  for (const localization::TrackErrorAt& row :
       workflows::track_errors({.track = "track.csv", .truth = "site/log.jsonl"}))
    if (row.error > 3 * row.sd) std::cout << row.t << " s: " << row.error << " m\n";
  //! [methods]
}

}  // namespace

int main() {
  for (const auto& step :
       {see_without_a_bearing_or_a_type, filters, move, find_anywhere, find_by_summits, localize_log})
    step();
}
