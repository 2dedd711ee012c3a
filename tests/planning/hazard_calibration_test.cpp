// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <random>

#include "planning/hazard_map.hpp"
#include "testbed/scenario.hpp"
#include "testbed/scene_files.hpp"
#include "tests/support/dem_art.hpp"

namespace waymark::test {
namespace {

using namespace planning;

/// Counts of cells by the probability of a hazard, and by the truth.
struct Reliability {
  static constexpr std::array<double, 11> kLimits{0,   0.01, 0.05, 0.1,  0.2,   0.35,
                                                  0.5, 0.65, 0.8,  0.95, 1.0001};
  std::array<double, 10> cells{}, probability{}, hazards{};

  void add(double p, bool hazard) {
    std::size_t bin = 0;
    while (p >= kLimits[bin + 1]) ++bin;
    ++cells[bin], probability[bin] += p, hazards[bin] += hazard;
  }
  /// Mean distance of probability and frequency over all cells.
  double calibration_error() const {
    double error = 0, all = 0;
    for (std::size_t i = 0; i < cells.size(); ++i)
      error += std::abs(probability[i] - hazards[i]), all += cells[i];
    return error / all;
  }
  void print(const char* title) const {
    std::printf("%s\n| probability | cells | mean probability | frequency |\n|---|---|---|---|\n", title);
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (cells[i] > 0)
        std::printf("| %.2f-%.2f | %.0f | %.3f | %.3f |\n", kLimits[i], std::min(1.0, kLimits[i + 1]),
                    cells[i], probability[i] / cells[i], hazards[i] / cells[i]);
  }
};

/// Site of 150 m with relief, craters and rocks; the map knows nine of ten rocks above 0.6 m.
struct Site {
  testbed::Scenario scenario;
  testbed::Scene scene;
  std::vector<HazardObject> objects;

  explicit Site(std::uint64_t seed, const Vehicle& vehicle)
      : scenario(scenario_of()), scene(testbed::make_scene(scenario.ground, seed)) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform(0, 1);
    const auto add = [&](double x, double y, double width, double height, double confidence) {
      const Uncertain measured{height * (1 + 0.1 * normal(random)), 0.1 * height};
      objects.push_back({.position = {x + 0.1 * normal(random), y + 0.1 * normal(random)},
                         .covariance = Eigen::Matrix2d::Identity() * 0.01,
                         .radius = width / 2 * (1 + 0.1 * normal(random)),
                         .radius_sd = 0.05 * width,
                         .probability = confidence * probability_above(measured, vehicle.obstacle_height())});
    };
    for (const testbed::TrueRock& rock : scene.rocks) {
      if (rock.width < 0.6) continue;
      // Half of the rocks are sure; the others come with as many false ones, and have a confidence of 1/2.
      const bool sure = uniform(random) < 0.5;
      add(rock.position.x(), rock.position.y(), rock.width, rock.height, sure ? 1 : 0.5);
      if (!sure)
        add(150 * (uniform(random) - 0.5), 150 * (uniform(random) - 0.5), rock.width, rock.height, 0.5);
    }
  }

  static testbed::Scenario scenario_of() {
    testbed::Scenario scenario;
    scenario.ground.cell = 0.25;
    scenario.ground.width = scenario.ground.height = 150;
    scenario.ground.relief.rms = 2;
    scenario.ground.relief.longest = 250;
    scenario.ground.craters.max_diameter = 40;
    scenario.ground.rocks = {.k = 0.1, .min_diameter = 0.3, .max_diameter = 3, .clustering = 0};
    scenario.dem = {.cell = 0.5, .height_sd = 0.05, .correlation = 5};
    return scenario;
  }
};

MemoryDem dem_of(const Grid<float>& heights, double x0, double y0, double cell) {
  Grid<double> grid(heights.columns(), heights.rows());
  for (std::size_t i = 0; i < grid.cells().size(); ++i)
    grid.cells()[i] = std::isnan(heights.cells()[i]) ? kNoHeight : double(heights.cells()[i]);
  return {std::move(grid), {.x0 = x0, .y0 = y0, .dx = cell, .dy = -cell}, NodataPolicy::unknown};
}

bool touches_a_rock(const testbed::Scene& scene, double x, double y, const Vehicle& vehicle) {
  for (const testbed::TrueRock& rock : scene.rocks)
    if (rock.height > vehicle.obstacle_height() &&
        std::hypot(rock.position.x() - x, rock.position.y() - y) < vehicle.base_radius() + rock.width / 2)
      return true;
  return false;
}

struct Outcome {
  Reliability relief, all;
  std::array<double, 3> slope{}, rough{}, step{};  // mean true value, mean estimate, rms normalized error
  double count = 0;
  double hazards = 0, found = 0, safe = 0, false_alarms = 0;  // cells at probability 0.5
};

Outcome drive_over_sites(const Vehicle& vehicle, int sites) {
  Outcome outcome;
  for (int seed = 1; seed <= sites; ++seed) {
    const Site site(static_cast<std::uint64_t>(seed), vehicle);
    const testbed::SimulatedDem given = testbed::simulate_dem(site.scenario.dem, site.scene);
    const MemoryDem dem = dem_of(given.heights, given.x0, given.y0, given.cell);
    UndetectedRocks undetected{
        .known = true, .cover = {0.1, 0}, .min_height = vehicle.obstacle_height(), .detected_diameter = 0.6};
    // The correlation of gradient noise falls to 1/e at about 0.4 of the spacing of its lattice.
    const HeightErrors errors{site.scenario.dem.height_sd, 0.4 * site.scenario.dem.correlation};
    const HazardMap map(dem, {.vehicle = vehicle, .errors = errors, .undetected = undetected}, site.objects);
    const HazardMap relief_map(dem, {.vehicle = vehicle, .errors = errors}, {});
    const Terrain& truth = site.scene.terrain;
    const MemoryDem true_dem = dem_of(truth.heights(), truth.x0(), truth.y0(), truth.step_x());
    const HazardMap true_map(true_dem, {.vehicle = vehicle}, {});
    const Window all{0, 0, dem.geometry().columns, dem.geometry().rows};
    const HazardTile tile = map.compute(all), relief = relief_map.compute(all);
    const HazardTile exact = true_map.compute({0, 0, true_dem.geometry().columns, true_dem.geometry().rows});
    const auto band = static_cast<std::size_t>(HazardBand::probability);
    for (std::int64_t r = 0; r < all.rows; ++r)
      for (std::int64_t c = 0; c < all.columns; ++c) {
        const double x = dem.geometry().where.x(double(c)), y = dem.geometry().where.y(double(r));
        const auto tc = std::llround(true_dem.geometry().where.column(x)),
                   tr = std::llround(true_dem.geometry().where.row(y));
        const double p = double(tile[band](c, r)), p_relief = double(relief[band](c, r));
        if (!exact[band].contains(tc, tr) || std::isnan(p) || std::isnan(p_relief)) continue;
        const double steep = double(exact[band](tc, tr));
        if (std::isnan(steep)) continue;
        const auto compare = [&](std::array<double, 3>& sums, HazardBand b) {
          const double t = double(exact[std::size_t(b)](tc, tr)), v = double(tile[std::size_t(b)](c, r)),
                       sd = double(tile[std::size_t(b) + 1](c, r));
          sums[0] += t, sums[1] += v, sums[2] += std::pow((v - t) / std::max(sd, 1e-6), 2);
        };
        compare(outcome.slope, HazardBand::slope);
        compare(outcome.rough, HazardBand::roughness);
        compare(outcome.step, HazardBand::step);
        outcome.count += 1;
        const bool hazard = steep > 0.5 || touches_a_rock(site.scene, x, y, vehicle);
        outcome.relief.add(p_relief, steep > 0.5);
        outcome.all.add(p, hazard);
        (hazard ? outcome.hazards : outcome.safe) += 1;
        if (p >= 0.5) (hazard ? outcome.found : outcome.false_alarms) += 1;
      }
  }
  return outcome;
}

TEST(HazardCalibration, ProbabilityIsAFrequency) {
  for (const char* name : {"rover", "lander"}) {
    Vehicle vehicle = find_vehicle(name);
    const Outcome outcome = drive_over_sites(vehicle, 2);
    outcome.relief.print((std::string(name) + ", relief alone").c_str());
    outcome.all.print((std::string(name) + ", relief and rocks").c_str());
    std::printf("recall %.3f, false %.3f of the safe, errors %.4f (relief) %.4f (all)\n",
                outcome.found / outcome.hazards, outcome.false_alarms / outcome.safe,
                outcome.relief.calibration_error(), outcome.all.calibration_error());
    for (const auto* sums : {&outcome.slope, &outcome.rough, &outcome.step})
      std::printf("true %.4f estimate %.4f normalized rms %.3f\n", (*sums)[0] / outcome.count,
                  (*sums)[1] / outcome.count, std::sqrt((*sums)[2] / outcome.count));
    for (const auto* sums : {&outcome.slope, &outcome.rough, &outcome.step})
      EXPECT_LT(std::sqrt((*sums)[2] / outcome.count), 1.5) << name;
    // The distance of probability and frequency, and of errors and their sd: measured .08 and 1.2 at most.
    EXPECT_LT(outcome.relief.calibration_error(), 0.1) << name;
    EXPECT_LT(outcome.all.calibration_error(), 0.05) << name;
  }
}

}  // namespace
}  // namespace waymark::test
