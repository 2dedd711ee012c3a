// SPDX-License-Identifier: Apache-2.0
// Localizes a rover that drives in a circle in a map of rocks: wheel odometry drifts, the filter corrects it.
#include <iostream>
#include <waymark/localization.hpp>
using namespace waymark;

namespace {

// Makes a map of sixty rocks of different sizes. For a map from a file:
// MapStore::open("landing.gpkg").query({}).
SemanticMap make_rock_map(Random& random) {
  TypeRegistry types;
  register_landmark_types(types);
  const TypeId rock = types.id("rock");
  std::vector<Landmark> rocks(60);
  for (std::size_t i = 0; i < rocks.size(); ++i) {
    Landmark& one = rocks[i];
    one.uid = "rock-" + std::to_string(i);
    one.type = rock;
    one.position.xyz = {random.uniform(-60, 60), random.uniform(-60, 60), 0};
    one.covariance = Eigen::Vector3d(0.1, 0.1, 0.1).cwiseAbs2().asDiagonal();
    one.features.resize(types[rock].features.size());
    one.features[feature_index(types[rock], "radius")] = {.value = random.log_uniform(0.2, 1.5),
                                                          .observations = 1};
    one.confidence = 0.95;
  }
  return SemanticMap(types, Crs::local(), std::move(rocks), {});
}

// Simulates a laser with a range of 25 m: range, bearing and radius with noise, without identities.
localization::SightingSet observe(const localization::Pose2& robot, const localization::LandmarkGrid& rocks,
                                  Random& random) {
  localization::SightingSet seen;
  for (const localization::MapLandmark& rock : rocks.landmarks()) {
    const Eigen::Vector2d away = rock.at - robot.at();
    if (away.norm() > 25) continue;
    localization::SeenLandmark one;
    one.type = rock.type;
    one.features = rock.features;
    one.range_sd = 0.05, one.bearing_sd = 0.01;
    one.range = away.norm() + random.normal(0, one.range_sd);
    one.bearing = localization::wrap_angle(std::atan2(away.y(), away.x()) - robot.yaw +
                                           random.normal(0, one.bearing_sd));
    one.features.value[0] *= random.normal(1, 0.1);
    seen.sightings.push_back(one);
  }
  return seen;
}

}  // namespace

int main() try {
  Random random(1, "rover");
  const SemanticMap map = make_rock_map(random);
  const localization::LandmarkGrid rocks(localization::to_map_landmarks(map));

  localization::Pose2 truth{0, -40, 0};
  const localization::PoseEstimate start{truth, Eigen::Vector3d(0.01, 0.01, 1e-4).asDiagonal()};
  localization::IdentificationOptions without_names;
  without_names.use_identities = false;
  localization::DeadReckoning odometry(start);
  localization::ExtendedKalman filter(
      start, localization::LandmarkMatcher(localization::LandmarkWindow(rocks),
                                           localization::FeatureScales(map.types()), without_names));

  const double speed = 0.5, turn = 0.0125, seconds = 1;  // a circle of 40 m about the middle of the map
  std::size_t sightings = 0, matched = 0;
  for (double t = 0; t < 500; t += seconds) {
    truth = truth * localization::twist_motion(speed, 0, turn, seconds, {}).step;
    const double slip = random.normal(0.97, 0.05), drift = random.normal(0.001, 0.005);
    const localization::BodyMotion wheels =
        localization::twist_motion(speed / slip, 0, turn + drift, seconds, {});
    odometry.predict(wheels);
    filter.predict(wheels);
    for (const localization::Match& match : filter.update(observe(truth, rocks, random)))
      ++sightings, matched += match.verdict == localization::Verdict::matched;
  }
  const auto error = [&](const localization::Localizer& localizer) {
    return (localizer.estimate().pose.at() - truth.at()).norm();
  };
  std::cout << "after 250 m: odometry is " << error(odometry) << " m off, the filter " << error(filter)
            << " m; " << matched << " of " << sightings << " sightings matched\n";
  return error(filter) < 0.3 && error(odometry) > 2 ? 0 : 1;
} catch (const Error& error) {
  std::cerr << error.what() << '\n';
  return exit_code(error.code());
}
