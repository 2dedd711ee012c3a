// SPDX-License-Identifier: Apache-2.0
// Poles in one turn of a 3-D scanner: 64 rows of 1,950 columns in a street, about 125,000 points, one core.
#include <benchmark/benchmark.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "localization/detectors/cloud_poles.hpp"

namespace waymark::bench {
namespace {

localization::PointCloud street() {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.02);
  localization::PointCloud cloud;
  constexpr double degree = std::numbers::pi / 180;
  for (int row = 0; row < 64; ++row)
    for (int column = 0; column < 1950; ++column) {
      const double up = (-24.8 + row * 26.8 / 63) * degree, around = column * 2 * std::numbers::pi / 1950;
      const Eigen::Vector3d ray(std::cos(up) * std::cos(around), std::cos(up) * std::sin(around),
                                std::sin(up));
      double range = ray.z() < 0 ? -1.73 / ray.z() : 70;
      range = std::min(range, 10 / std::max(1e-3, std::abs(ray.y())));  // house fronts
      for (double x = -35; x < 40; x += 5) {                            // a pole each 5 m, 0.2 m wide
        const double along = ray.x() * x + ray.y() * 6, across = ray.x() * 6 - ray.y() * x;
        if (along > 0 && std::abs(across) < 0.1 * ray.head<2>().norm())
          range = std::min(range, along / ray.head<2>().squaredNorm());
      }
      cloud.points.push_back(((range + noise(random)) * ray).cast<float>());
    }
  return cloud;
}

void FindPoles(benchmark::State& state) {
  const localization::PointCloud cloud = street();
  std::size_t found = 0;
  for (auto _ : state) found = localization::find_poles(cloud).size();
  state.counters["points"] = static_cast<double>(cloud.points.size());
  state.counters["poles"] = static_cast<double>(found);
  state.counters["scans"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(FindPoles)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace waymark::bench

BENCHMARK_MAIN();
