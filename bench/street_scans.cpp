// SPDX-License-Identifier: Apache-2.0
// Facades, signs and kerbs in one turn of a 3-D scanner of 64 rows in a made street, reflectors and walls in
// a line scan, and pulses of a survey of the street from the air; one core.
#include <benchmark/benchmark.h>

#include <cmath>

#include "core/random.hpp"
#include "localization/detectors/cloud_curbs.hpp"
#include "localization/detectors/cloud_facades.hpp"
#include "localization/detectors/cloud_signs.hpp"
#include "localization/detectors/laser_reflectors.hpp"
#include "localization/detectors/wall_lines.hpp"
#include "testbed/town/town_scanner.hpp"
#include "testbed/town/town_survey.hpp"

namespace waymark::bench {
namespace {

localization::PointCloud street() {
  Random random(1);
  return testbed::turn_of_scanner(testbed::plan_street({}, 1, 1), {0, -1.2, 0}, 0,
                                  {.rows = 64, .step = Degrees{0.17}}, random);
}

template <class Find>
void find_in_street(benchmark::State& state, const Find& find) {
  const localization::PointCloud cloud = street();
  std::size_t found = 0;
  for (auto _ : state) found = find(cloud).size();
  state.counters["points"] = static_cast<double>(cloud.points.size());
  state.counters["found"] = static_cast<double>(found);
  state.counters["scans"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
}

void FindFacades(benchmark::State& state) {
  find_in_street(state, [](const auto& cloud) { return localization::find_facades(cloud); });
}
BENCHMARK(FindFacades)->Unit(benchmark::kMillisecond);

void FindSigns(benchmark::State& state) {
  find_in_street(state, [](const auto& cloud) { return localization::find_signs(cloud); });
}
BENCHMARK(FindSigns)->Unit(benchmark::kMillisecond);

void FindSignsByShape(benchmark::State& state) {
  find_in_street(state, [](localization::PointCloud cloud) {
    cloud.intensities.clear();
    return localization::find_signs(cloud);
  });
}
BENCHMARK(FindSignsByShape)->Unit(benchmark::kMillisecond);

void FindCurbs(benchmark::State& state) {
  find_in_street(state, [](const auto& cloud) { return localization::find_curbs(cloud); });
}
BENCHMARK(FindCurbs)->Unit(benchmark::kMillisecond);

void FindReflectors(benchmark::State& state) {
  Random random(1);
  localization::LaserScan scan{
      .robot_from_sensor = {}, .first_angle = -2.356, .angle_step = 0.004363, .ranges = {}, .max_range = 30};
  for (int i = 0; i < 1081; ++i) {
    const bool post = i % 100 < 4;
    scan.ranges.push_back(static_cast<float>(post ? 5 : 9 + random.normal(0, 0.02)));
    scan.intensities.push_back(static_cast<float>(post ? 1 : 0.2 + random.uniform(0, 0.1)));
  }
  std::size_t found = 0;
  for (auto _ : state) found = localization::find_reflectors(scan).size();
  state.counters["found"] = static_cast<double>(found);
}
BENCHMARK(FindReflectors)->Unit(benchmark::kMicrosecond);

/// In a corridor of a made hall.
void FindWallLines(benchmark::State& state) {
  const testbed::Town hall = testbed::plan_hall({}, 1, 1);
  Random random(1);
  localization::LaserScan scan{
      .robot_from_sensor = {}, .first_angle = -2.356, .angle_step = 0.004363, .ranges = {}, .max_range = 30};
  const Eigen::Vector2d at = hall.path.at(20);
  for (int i = 0; i < 1081; ++i) {
    const double angle = scan.first_angle + i * scan.angle_step;
    const auto range = hall.cast(at, {std::cos(angle), std::sin(angle)}, 0);
    scan.ranges.push_back(static_cast<float>(range ? *range + random.normal(0, 0.02) : 0));
  }
  std::size_t found = 0;
  for (auto _ : state)
    found = localization::join_collinear(localization::find_wall_lines(scan, {.min_length = 1})).size();
  state.counters["found"] = static_cast<double>(found);
}
BENCHMARK(FindWallLines)->Unit(benchmark::kMicrosecond);

void SurveyFromTheAir(benchmark::State& state) {
  const testbed::StreetModel model{.survey_pulses = 8};
  const testbed::Town town = testbed::plan_street(model, 1, 1);
  std::int64_t returns = 0;
  for (auto _ : state)
    testbed::survey_town(town, model, 1,
                         [&](std::span<const testbed::LaserReturn> row) { returns += std::ssize(row); });
  state.SetItemsProcessed(returns);
}
BENCHMARK(SurveyFromTheAir)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace waymark::bench

BENCHMARK_MAIN();
