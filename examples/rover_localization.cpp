// SPDX-License-Identifier: Apache-2.0
// Localizes a rover that drives in a circle in a map of rocks: wheel odometry drifts, the filter corrects it.
#include <iostream>
#include <waymark/localization.hpp>
using namespace waymark;
using namespace waymark::localization;

namespace {
// Makes sixty rocks of different sizes. For a map from a file: MapStore::open("landing.gpkg").query({}).
SemanticMap make_rock_map(Random& random) {
  TypeRegistry types;
  register_landmark_types(types);
  std::vector<Landmark> rocks(60);
  for (Landmark& rock : rocks) {
    rock.uid = "rock-" + std::to_string(&rock - rocks.data()), rock.type = types.id("rock");
    rock.position.xyz = {random.uniform(-60, 60), random.uniform(-60, 60), 0};
    rock.covariance = Eigen::Vector3d(0.1, 0.1, 0.1).cwiseAbs2().asDiagonal(), rock.confidence = 0.95;
    rock.features.resize(types[rock.type].features.size());
    const std::size_t radius = feature_index(types[rock.type], "radius");
    rock.features[radius] = {.value = random.log_uniform(0.2, 1.5), .observations = 1};
  }
  return SemanticMap(types, Crs::local(), std::move(rocks), {});
}

// Simulates a laser with a range of 25 m: range, bearing and radius with noise, without identities.
SightingSet observe(const Pose2& robot, const LandmarkGrid& rocks, Random& random) {
  SightingSet seen;
  for (const MapLandmark& rock : rocks.landmarks()) {
    const Eigen::Vector2d away = rock.at - robot.at();
    if (away.norm() > 25) continue;
    SeenLandmark& one = seen.sightings.emplace_back();
    one.type = rock.type, one.features = rock.features, one.range_sd = 0.05, one.bearing_sd = 0.01;
    one.range = away.norm() + random.normal(0, one.range_sd);
    one.bearing = wrap_angle(std::atan2(away.y(), away.x()) - robot.yaw + random.normal(0, one.bearing_sd));
    one.features.value[0] *= random.normal(1, 0.1);
  }
  return seen;
}
}  // namespace

int main() {
  Random random(1, "rover");
  const SemanticMap map = make_rock_map(random);
  const LandmarkGrid rocks(to_map_landmarks(map));
  Pose2 truth{0, -40, 0};
  const PoseEstimate start{truth, Eigen::Vector3d(0.01, 0.01, 1e-4).asDiagonal()};
  DeadReckoning odometry(start);
  ExtendedKalman filter(start, LandmarkMatcher(LandmarkWindow(rocks), FeatureScales(map.types()), {}));
  for (int second = 0; second < 500; ++second) {  // a circle of 40 m about the middle of the map
    truth = truth * twist_motion(0.5, 0, 0.0125, 1, {}).step;
    const double slip = random.normal(0.97, 0.05), drift = random.normal(0.001, 0.005);
    const BodyMotion wheels = twist_motion(0.5 / slip, 0, 0.0125 + drift, 1, {});
    odometry.predict(wheels), filter.predict(wheels);
    filter.update(observe(truth, rocks, random));
  }
  const double lost = (odometry.estimate().pose.at() - truth.at()).norm();
  const double error = (filter.estimate().pose.at() - truth.at()).norm();
  std::cout << "after 250 m odometry is " << lost << " m off, the filter " << error << " m\n";
  return error < 0.3 && lost > 2 ? 0 : 1;
}
