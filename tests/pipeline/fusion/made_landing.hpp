// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <map>
#include <vector>
#include "core/random.hpp"
#include "pipeline/fusion/association/merging.hpp"
#include "pipeline/fusion/projection/detection_projection.hpp"
#include "pipeline/fusion/projection/image_view_factory.hpp"
#include "testbed/scene_files.hpp"
namespace waymark::test {
using namespace pipeline;

/// Performance of a simulated detector; errors in pixels, as it reports them.
struct MadeDetector {
  double recall = 0.85;
  double min_diameter = 3;  ///< pixels
  double centre_sd = 0.2, centre_sd_of_diameter = 0.02;
  double size_sd_of_diameter = 0.07;
  double false_fraction = 0.05;  ///< false detections per true one
};

/// Landing without pictures: scene, poses with errors, DEM with errors, and the detections of a simulated
/// detector. `thing` holds the truth of each observation.
struct MadeLanding {
  testbed::Scene scene;
  Terrain dem;
  std::vector<ImageView> images;
  std::vector<Observation> observations;
  std::vector<int> thing;  ///< per observation: index of the crater, or craters + index of the rock; -1 false
  TypeRegistry types;

  Eigen::Vector2d true_position(int truth) const {
    const auto t = static_cast<std::size_t>(truth);
    return t < scene.craters.size() ? scene.craters[t].position.head<2>().eval()
                                    : scene.rocks[t - scene.craters.size()].position.head<2>().eval();
  }
};

inline Terrain given_terrain(const testbed::Scenario& scenario, const testbed::Scene& scene) {
  testbed::SimulatedDem dem = testbed::simulate_dem(scenario.dem, scene);
  return {std::move(dem.heights), dem.x0, dem.y0, dem.cell, dem.cell, scenario.dem.height_sd};
}

inline MadeLanding made_landing(testbed::Scenario scenario, const MadeDetector& detector = {}) {
  const std::vector<testbed::Shot> shots = testbed::plan_shots(scenario);
  scenario.ground = testbed::size_site(scenario, shots);
  testbed::Scene scene = testbed::make_scene(scenario.ground, static_cast<std::uint64_t>(scenario.seed));
  Terrain dem = given_terrain(scenario, scene);
  MadeLanding made{std::move(scene), std::move(dem), {}, {}, {}, {}};
  register_landmark_types(made.types);
  Random random(static_cast<std::uint64_t>(scenario.seed), "made detector");
  for (const testbed::Shot& shot : shots) {
    ImageInfo info;
    info.name = shot.name;
    info.columns = shot.view.camera.columns, info.rows = shot.view.camera.rows;
    info.view = shot.view;
    info.view->grid_from_camera = shot.reported;
    info.sun = scenario.exposure.sun;
    ImageView image = make_image_view(info);
    compute_footprint(image, made.dem, 1);
    const testbed::View view = testbed::camera_view(shot.view);
    const double tangent = std::tan(to_radians(scenario.exposure.sun.elevation).value);
    const auto see = [&](const PixelEllipse& outline, TypeId type, double height_over_diameter, int thing,
                         double confidence) {
      Detection d;
      d.type = type;
      d.outline = outline;
      const double sd = std::hypot(detector.centre_sd, detector.centre_sd_of_diameter * outline.diameter());
      d.outline.x += random.normal(0, sd), d.outline.y += random.normal(0, sd);
      const double scale = std::exp(random.normal(0, detector.size_sd_of_diameter));
      d.outline.major *= scale, d.outline.minor *= scale;
      d.covariance = Eigen::Matrix2d::Identity() * sd * sd;
      d.diameter_sd = detector.size_sd_of_diameter * outline.diameter();
      if (height_over_diameter > 0) {
        const double reach = height_over_diameter * outline.diameter() / tangent;
        d.shadow_reach = MeasuredValue{reach * (1 + random.normal(0, 0.1)), 0.1 * reach};
      }
      d.confidence = confidence;
      ProjectionRules rules{.outline_edge_fraction = 0};  // this detector reports crests
      rules.shadow_shape = 0;                             // the simulated detector has no shape error
      const Observation o = project_detection(d, image, made.dem, made.types[type], rules);
      if (!o.rejected.empty()) return;
      made.observations.push_back(o);
      made.thing.push_back(thing);
    };
    std::size_t before = made.observations.size();
    const auto craters = static_cast<int>(made.scene.craters.size());
    for (int i = 0; i < craters; ++i) {
      const testbed::TrueCrater& crater = made.scene.craters[static_cast<std::size_t>(i)];
      if (crater.preserved_fraction() < testbed::kErased) continue;
      const auto outline = testbed::image_outline(view, crater);
      if (outline && outline->diameter() >= 2 * detector.min_diameter && random.bernoulli(detector.recall))
        see(*outline, made.types.id("crater"), 0, i, random.uniform(0.6, 1));
    }
    for (int i = 0; i < static_cast<int>(made.scene.rocks.size()); ++i) {
      const testbed::TrueRock& rock = made.scene.rocks[static_cast<std::size_t>(i)];
      const auto outline = testbed::image_outline(view, rock);
      if (outline && outline->diameter() >= detector.min_diameter && random.bernoulli(detector.recall))
        see(*outline, made.types.id("rock"), rock.height / rock.width, craters + i, random.uniform(0.6, 1));
    }
    const double wrong = detector.false_fraction * static_cast<double>(made.observations.size() - before);
    for (std::uint64_t i = random.poisson(wrong); i > 0; --i) {
      const double d = detector.min_diameter * random.log_uniform(1, 4);
      see({random.uniform(d, static_cast<double>(image.columns) - d),
           random.uniform(d, static_cast<double>(image.rows) - d), d, d, 0},
          made.types.id("rock"), 0.5, -1, random.uniform(0.5, 0.8));
    }
    made.images.push_back(std::move(image));
  }
  return made;
}

/// Comparison of landmarks with truth.
struct MergeScore {
  int things = 0;     ///< true ones seen at least once
  int landmarks = 0;  ///< with at least one true observation
  int doubled = 0;    ///< landmarks beyond the first of their thing
  int mixed = 0;      ///< landmarks of observations of different things (false ones are things of their own)
  int checked = 0, inside = 0;  ///< pure landmarks, those whose 90 % ellipse holds the truth
  double nees = 0;
};

inline MergeScore merge_score(const MadeLanding& made, const MergedObservations& merged) {
  // Evidence has another order: finds the truth of each observation by content.
  std::vector<std::size_t> order(made.observations.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return comes_before(made.observations[a], made.observations[b]);
  });
  std::map<std::string, std::map<int, int>> things_of;  // uid -> thing -> observations
  MergeScore s;
  std::map<int, int> landmarks_of;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const int thing = made.thing[order[i]];
    if (thing >= 0) landmarks_of.emplace(thing, 0);
    if (!merged.evidence[i].landmark_uid.empty())
      ++things_of[merged.evidence[i].landmark_uid][thing >= 0 ? thing : -1 - static_cast<int>(i)];
  }
  s.things = static_cast<int>(landmarks_of.size());
  for (const Landmark& landmark : merged.landmarks) {
    const auto& things = things_of[landmark.uid];
    int main = -1, most = 0;
    for (const auto& [thing, count] : things)
      if (thing >= 0 && count > most) main = thing, most = count;
    s.mixed += things.size() > 1;
    if (main < 0) continue;
    ++s.landmarks;
    s.doubled += landmarks_of[main]++ > 0;
    if (things.size() > 1) continue;
    const Eigen::Vector2d error = landmark.position.xyz.head<2>() - made.true_position(main);
    const Eigen::Matrix2d covariance = landmark.covariance.topLeftCorner<2, 2>();
    const double squared = error.dot(covariance.inverse() * error);
    ++s.checked;
    s.inside += squared <= 4.605;
    s.nees += squared;
  }
  s.nees /= std::max(s.checked, 1);
  return s;
}

}  // namespace waymark::test
