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
SightingSet see_a() {
  SeenLandmark a;
  a.identity = landmark_key("a");
  a.range = std::hypot(8, 2), a.range_sd = 0.05;
  a.bearing = std::atan2(2, 8), a.bearing_sd = 0.01;
  SightingSet seen;
  seen.sightings = {a};
  return seen;
}
//! [sighting]

void follow(Localizer& filter) {
  //! [filter]
  filter.predict(twist_motion(0.5, 0, 0.1, 0, {}));  // m/s forward, m/s left, rad/s, s: stands still
  for (const Match& match : filter.update(see_a())) std::cout << wording(match.verdict) << '\n';
  const PoseEstimate now = filter.estimate();
  std::cout << now.pose.at().transpose() << " m, +- " << std::sqrt(now.covariance(0, 0)) << " m\n";
  //! [filter]
}

void filters() {
  //! [filters]
  const SemanticMap map = rock_map();
  const LandmarkGrid rocks(to_map_landmarks(map));
  const PoseEstimate start{{0.2, -0.1, 0.02}, Eigen::Vector3d(0.1, 0.1, 0.01).asDiagonal()};  // m2, m2, rad2
  ExtendedKalman ekf(start, LandmarkWindow(rocks), FeatureScales(map.types()));
  UnscentedKalman ukf(start, LandmarkWindow(rocks), FeatureScales(map.types()));
  ParticleFilter particles(start, LandmarkWindow(rocks), FeatureScales(map.types()));
  DeadReckoning odometry(start);
  //! [filters]
  for (Localizer* filter : {static_cast<Localizer*>(&ekf), static_cast<Localizer*>(&ukf),
                            static_cast<Localizer*>(&particles), static_cast<Localizer*>(&odometry)})
    follow(*filter);
}

void find_anywhere() {
  //! [constellation]
  const SemanticMap map = rock_map();
  const ConstellationIndex index(to_map_landmarks(map), FeatureScales(map.types()));
  const ConstellationAnswer answer = index.find(see_a());
  if (!answer.fix) std::cout << "no fix: " << answer.reason << '\n';
  //! [constellation]
}

void find_by_summits() {
  //! [skyline]
  const TerrainHeight ground = [](const Eigen::Vector2d& at) {
    return 50 * std::sin(at.x() / 300);
  };                                      // metres
  const std::vector<HorizonTop> tops(2);  // bearings and elevations of tops, radians
  const SkylineAnswer answer = find_by_skyline(tops, std::vector<SkylineSummit>(2), ground);
  if (!answer.fix) std::cout << "no fix: " << answer.reason << '\n';
  //! [skyline]
}

void localize_log() {
  std::ofstream("drive.json")
      << R"({"waymark_scenario": 1, "crs": "local", "seed": 11, "ground": {"cell": 0.5},
    "rocks": {"k": 0.16, "min_diameter": 0.5, "max_diameter": 4}, "camera": {"columns": 200, "rows": 200},
    "flights": [{"name": "view", "images": 1, "from_altitude": 150, "to_altitude": 150}],
    "drive": {"vehicle": "rover", "length": 60, "laser": {"every": 2, "step": 0.5}}})";
  simulate({.scenario = "drive.json", .folder = "site"});
  ImportRequest map{.table = "site/truth/landmarks.csv", .map = "site.gpkg"};
  map.options.map_crs = "local";
  import_landmarks(map);
  //! [localize]
  LocalizeRequest request{.map = "site.gpkg", .log = "site/log.jsonl"};  // as `waymark localize ...`
  request.output = "track.csv";
  request.method = "ekf";
  request.start = "truth";
  std::cout << localize(request).track.rows.size() << " poses\n";
  const TrackScore score = evaluate(TrackEvaluation{.track = "track.csv", .truth = "site/log.jsonl"});
  std::cout << score.ate_rmse << " m\n";
  //! [localize]
}

}  // namespace

int main() {
  for (const auto& step : {filters, find_anywhere, find_by_summits, localize_log}) step();
}
