// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/cleaning/shaded_by_relief.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace waymark::pipeline {
namespace {

constexpr double kLift = 0.05;  // metres above the terrain; rounding of heights casts no shadow

double cell_of(const Terrain& terrain) {
  return std::max(terrain.step_x(), terrain.step_y());
}

Eigen::Vector2d on_ring(int k, int count) {
  const double t = 2 * std::numbers::pi * k / count;
  return {std::cos(t), std::sin(t)};
}

// Light relative to that of level terrain; NaN where heights are unknown.
class Light {
 public:
  Light(const Terrain& terrain, const Eigen::Vector3d& towards) : terrain_(terrain), towards_(towards) {}

  double at(const Eigen::Vector2d& p) const {
    const double step = cell_of(terrain_);
    const auto h = [&](double dx, double dy) {
      return terrain_.height(p.x() + dx, p.y() + dy).value_or(std::nan(""));
    };
    const Eigen::Vector3d normal((h(-step, 0) - h(step, 0)) / (2 * step),
                                 (h(0, -step) - h(0, step)) / (2 * step), 1);
    const double cosine = normal.normalized().dot(towards_);
    if (!(cosine > 0)) return std::isnan(cosine) ? cosine : 0;
    return terrain_.in_shadow({{p.x(), p.y(), h(0, 0) + kLift}}, {towards_}) ? 0 : cosine / towards_.z();
  }

 private:
  const Terrain& terrain_;
  Eigen::Vector3d towards_;
};

// Mean over a disc that the ellipse of the shadow is mapped to.
double light_in_shadow(const Light& light, const Eigen::Vector2d& middle, const Eigen::Vector2d& half_along,
                       const Eigen::Vector2d& half_across) {
  double sum = 0;
  int count = 0;
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j) {
      if (i * i + j * j > 5) continue;
      sum += light.at(middle + 0.4 * i * half_along + 0.4 * j * half_across);
      ++count;
    }
  return sum / count;
}

double median_light_around(const Light& light, const Eigen::Vector2d& middle, double reach) {
  constexpr int kAzimuths = 24;
  std::vector<double> values;
  for (const double radii : {2.5, 3.5})
    for (int k = 0; k < kAzimuths; ++k)
      if (const double one = light.at(middle + radii * reach * on_ring(k, kAzimuths)); !std::isnan(one))
        values.push_back(one);
  if (values.size() < kAzimuths) return std::nan("");
  const auto half = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), half, values.end());
  return *half;
}

double height_over_surroundings(const Terrain& terrain, const SupposedRock& rock) {
  constexpr int kAzimuths = 16;
  const auto h = [&](const Eigen::Vector2d& p) {
    return terrain.height(p.x(), p.y()).value_or(std::nan(""));
  };
  const double outside = std::max(1.6 * rock.radius, rock.radius + cell_of(terrain));
  double top = h(rock.foot) / 5, around = -std::numeric_limits<double>::infinity();
  for (int k = 0; k < kAzimuths; ++k) {
    const Eigen::Vector2d direction = on_ring(k, kAzimuths);
    top += 0.8 * h(rock.foot + 0.5 * rock.radius * direction) / kAzimuths;
    const double edge = h(rock.foot + outside * direction);
    if (std::isnan(edge)) return edge;
    around = std::max(around, edge);
  }
  return top - around;
}

// Standard deviation of the brighter half about the median.
double bright_spread(std::vector<double> lights, std::size_t min_count) {
  if (lights.size() < min_count) return 0;
  std::ranges::sort(lights);
  const auto at = [&](double fraction) {
    return lights[static_cast<std::size_t>(fraction * double(lights.size() - 1))];
  };
  return at(0.84) - at(0.5);
}

}  // namespace

std::optional<ReliefAtRock> measure_relief(const Terrain& terrain, const SupposedRock& rock,
                                           const Eigen::Vector3d& towards_light) {
  const double level = towards_light.head<2>().norm();
  if (!(2 * rock.radius >= cell_of(terrain)) || !(rock.height > 0) || !(towards_light.z() > 0) ||
      !(level > 1e-6))
    return std::nullopt;
  const Eigen::Vector2d away = -towards_light.head<2>() / level, across(-away.y(), away.x());
  // The shadow of a half ellipsoid ends at `tip` and begins on the rock at `root`.
  const double tip = std::hypot(rock.radius, rock.height * level / towards_light.z());
  const double root = rock.radius * rock.radius / tip, half = (tip - root) / 2;
  const Eigen::Vector2d middle = rock.foot + away * (tip + root) / 2;
  const Light light(terrain, towards_light);
  const double around = median_light_around(light, middle, std::max(rock.radius, half));
  constexpr double kDark = 0.05;  // terrain around that is darker shows no shadow
  const ReliefAtRock seen{
      light_in_shadow(light, middle, half * away, rock.radius * across) / (around < kDark ? kDark : around),
      height_over_surroundings(terrain, rock) / rock.height};
  if (std::isnan(seen.light) || std::isnan(seen.stands_out)) return std::nullopt;
  return seen;
}

std::vector<char> explained_by_relief(const Terrain& terrain, std::span<const SupposedRock> rocks,
                                      const Eigen::Vector3d& towards_light, const ReliefRules& rules) {
  std::vector<std::optional<ReliefAtRock>> relief(rocks.size());
  tbb::parallel_for(std::size_t{0}, rocks.size(),
                    [&](std::size_t i) { relief[i] = measure_relief(terrain, rocks[i], towards_light); });
  std::vector<double> lights;
  for (const auto& seen : relief)
    if (seen) lights.push_back(seen->light);
  const double drop = std::max(rules.min_drop, rules.drop_sds * bright_spread(lights, rules.min_count));
  std::vector<char> explained(rocks.size(), 0);
  for (std::size_t i = 0; i < rocks.size(); ++i) {
    const double cells = 2 * rocks[i].radius / cell_of(terrain);
    if (!relief[i] || !(cells >= rules.min_cells)) continue;
    // Averaging over a cell flattens a body by about 3/4 of a cell per radius.
    const double body = rules.min_stands_out * std::max(0.0, 1 - 1.5 / cells);
    explained[i] = relief[i]->light < 1 - drop && !(relief[i]->stands_out > body);
  }
  return explained;
}

}  // namespace waymark::pipeline
