// SPDX-License-Identifier: Apache-2.0
#include "workflows/training/rock_relief.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/random.hpp"
#include "workflows/training/value_noise.hpp"

namespace waymark::workflows {
namespace {

constexpr double kPi = std::numbers::pi;

struct Body {
  TrueRockInImage truth;
  RockScene::Shape shape;
  double wave[3] = {}, phase[3] = {};  // of an irregular outline
  double power = 2, tilt_x = 0, tilt_y = 0;
};

double outline_factor(const Body& body, double angle) {
  double factor = 1;
  for (int k = 0; k < 3; ++k) factor += body.wave[k] * std::cos((k + 2) * angle + body.phase[k]);
  return factor;
}

double height_of(const Body& body, double dx, double dy) {
  const double r = 0.5 * body.truth.diameter, d = std::hypot(dx, dy);
  if (body.shape == RockScene::Shape::cylinder) return d < r ? body.truth.height : -1;
  if (body.shape == RockScene::Shape::ellipsoid)
    return d < r ? body.truth.height * std::sqrt(1 - d * d / (r * r)) : -1;
  const double q = d / (r * outline_factor(body, std::atan2(dy, dx)));
  if (q >= 1) return -1;
  const double top = std::pow(1 - std::pow(q, body.power), 1 / body.power);
  return body.truth.height * std::max(0.02, top * (1 + (body.tilt_x * dx + body.tilt_y * dy) / r));
}

Body make_body(const RockScene& scene, double x, double y, double diameter, Random& random) {
  Body body{.truth = {.x = x, .y = y, .diameter = diameter}, .shape = scene.shape};
  if (scene.shape == RockScene::Shape::mixed) {
    const double pick = random.uniform();
    body.shape = pick < 0.4   ? RockScene::Shape::ellipsoid
                 : pick < 0.9 ? RockScene::Shape::irregular
                              : RockScene::Shape::cylinder;
  }
  body.truth.height = diameter * random.uniform(scene.min_height, scene.max_height);
  body.truth.reach = body.truth.height * std::tan(to_radians(scene.incidence).value);
  if (body.shape != RockScene::Shape::irregular) return body;
  for (int k = 0; k < 3; ++k) {
    body.wave[k] = random.normal(0, 0.14 / (k + 1));
    body.phase[k] = random.uniform(0, 2 * kPi);
  }
  body.power = random.uniform(1.6, 4);
  body.tilt_x = random.normal(0, 0.15);
  body.tilt_y = random.normal(0, 0.15);
  double area = 0;  // the truth's diameter is that of the circle of equal area
  for (int i = 0; i < 360; ++i) area += std::pow(outline_factor(body, i * kPi / 180), 2) / 360;
  double max_height = 0;  // and its height that of the highest point
  Body unit = body;
  for (int i = -20; i <= 20; ++i)
    for (int j = -20; j <= 20; ++j)
      max_height = std::max(max_height, height_of(unit, i * 0.035 * diameter, j * 0.035 * diameter));
  body.truth.diameter = diameter * std::sqrt(area);
  body.truth.height = max_height;
  body.truth.reach = max_height * std::tan(to_radians(scene.incidence).value);
  return body;
}

struct Bowl {
  double x, y, radius, depth, rim;
};

double bowl_height(const Bowl& bowl, double x, double y) {
  const double d = std::hypot(x - bowl.x, y - bowl.y) / bowl.radius;
  if (d > 2.5) return 0;
  if (d < 1) return -bowl.depth * (1 - d * d) + bowl.rim;
  return bowl.rim * std::pow(d, -3);
}

std::vector<Bowl> make_bowls(const RockScene& scene, Random& random) {
  std::vector<Bowl> bowls;
  const double area = static_cast<double>(scene.columns * scene.rows);
  for (double covered = 0; covered < scene.craters * area;) {
    const double radius = random.log_uniform(2, 30), fresh = random.uniform();
    bowls.push_back({random.uniform(0, static_cast<double>(scene.columns)),
                     random.uniform(0, static_cast<double>(scene.rows)), radius,
                     radius * (0.08 + 0.32 * fresh * fresh), radius * 0.08 * fresh});
    covered += kPi * radius * radius;
  }
  return bowls;
}

std::vector<Body> make_bodies(const RockScene& scene, Random& random) {
  std::vector<double> sizes;
  const double area = static_cast<double>(scene.columns * scene.rows);
  for (double covered = 0; covered < scene.cover * area;) {
    double d = random.log_uniform(scene.min_diameter, scene.max_diameter);
    if (!scene.log_uniform) {
      const double a = 1 / (scene.min_diameter * scene.min_diameter),
                   b = 1 / (scene.max_diameter * scene.max_diameter);
      d = 1 / std::sqrt(random.uniform(b, a));
    }
    sizes.push_back(d);
    covered += 0.25 * kPi * d * d;
  }
  std::sort(sizes.rbegin(), sizes.rend());
  std::vector<Body> bodies;
  for (const double d : sizes)
    for (int attempt = 0; attempt < 30; ++attempt) {
      const double x = random.uniform(0, static_cast<double>(scene.columns - 1));
      const double y = random.uniform(0, static_cast<double>(scene.rows - 1));
      const bool free = std::all_of(bodies.begin(), bodies.end(), [&](const Body& other) {
        return std::hypot(other.truth.x - x, other.truth.y - y) > 0.65 * (other.truth.diameter + d) + 1;
      });
      if (!free) continue;
      bodies.push_back(make_body(scene, x, y, d, random));
      break;
    }
  return bodies;
}

// Slope, fractal roughness and dunes.
class Ground {
 public:
  Ground(const RockScene& scene, double dune_angle)
      : scene_(scene),
        dune_angle_(dune_angle),
        rough_{ValueNoise(scene.seed * 3 + 1), ValueNoise(scene.seed * 3 + 1), ValueNoise(scene.seed * 3 + 1),
               ValueNoise(scene.seed * 3 + 1)},
        bend_(scene.seed * 3 + 3),
        cover_bend_(bend_),
        slope_x_(-std::tan(to_radians(scene.slope).value) * std::cos(to_radians(scene.downhill).value)),
        slope_y_(-std::tan(to_radians(scene.slope).value) * std::sin(to_radians(scene.downhill).value)) {}

  double height(double x, double y) {
    double z = slope_x_ * x + slope_y_ * y;
    for (std::size_t octave = 0; octave < rough_.size(); ++octave) {
      const double length = 40 / static_cast<double>(1 << octave);
      z += 0.35 * scene_.roughness * length *
           rough_[octave].at(x / length + 31 * static_cast<double>(octave), y / length);
    }
    if (scene_.dunes > 0) {
      const double along = x * std::cos(dune_angle_) + y * std::sin(dune_angle_);
      const double phase = along / scene_.dune_length + 0.8 * bend_.at(x / 60, y / 60);
      const double saw = phase - std::floor(phase);  // a gentle windward side and a steep lee
      const double cover = std::clamp(cover_bend_.at(x / 90 + 9, y / 90) + 0.6, 0.0, 1.0);
      z += cover * scene_.dunes * (saw < 0.7 ? saw / 0.7 : (1 - saw) / 0.3);
    }
    return z;
  }

 private:
  const RockScene& scene_;
  double dune_angle_;
  std::array<ValueNoise, 4> rough_;  // one for each octave, so that each keeps its own square
  ValueNoise bend_, cover_bend_;
  double slope_x_, slope_y_;
};

// Calls change(height, x, y) for the samples of a square about a position, pixels.
template <class Change>
void change(RockRelief& relief, double x, double y, double reach, Change&& change) {
  const auto low = [&](double c) {
    return static_cast<std::int64_t>((c + static_cast<double>(RockRelief::kMargin) - reach) *
                                     RockRelief::kSamples);
  };
  const auto high = [&](double c) {
    return static_cast<std::int64_t>((c + static_cast<double>(RockRelief::kMargin) + reach + 1) *
                                     RockRelief::kSamples);
  };
  for (auto v = std::max<std::int64_t>(0, low(y)); v < std::min(relief.rows, high(y)); ++v)
    for (auto u = std::max<std::int64_t>(0, low(x)); u < std::min(relief.columns, high(x)); ++u)
      change(relief(u, v), RockRelief::pixel(u), RockRelief::pixel(v));
}

}  // namespace

RockRelief make_rock_relief(const RockScene& scene) {
  Random random(scene.seed, "rock scene");
  const auto bodies = make_bodies(scene, random);
  const auto bowls = make_bowls(scene, random);
  RockRelief relief(scene.columns, scene.rows);
  Ground ground(scene, random.uniform(0, 2 * kPi));
  for (std::int64_t v = 0; v < relief.rows; ++v)
    for (std::int64_t u = 0; u < relief.columns; ++u)
      relief(u, v) = static_cast<float>(ground.height(RockRelief::pixel(u), RockRelief::pixel(v)));
  for (const Bowl& bowl : bowls)
    change(relief, bowl.x, bowl.y, 2.5 * bowl.radius,
           [&](float& z, double x, double y) { z += static_cast<float>(bowl_height(bowl, x, y)); });
  for (const Body& body : bodies) {
    change(relief, body.truth.x, body.truth.y, body.truth.diameter, [&](float& z, double x, double y) {
      const double top = height_of(body, x - body.truth.x, y - body.truth.y);
      if (top >= 0) z += static_cast<float>(top);
    });
    relief.rocks.push_back(body.truth);
  }
  return relief;
}

}  // namespace waymark::workflows
