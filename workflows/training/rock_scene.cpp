// SPDX-License-Identifier: Apache-2.0
#include "workflows/training/rock_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "core/random.hpp"
namespace waymark::workflows {
namespace {

constexpr int kFine = 4;  // samples per pixel and direction
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

// Smooth noise of unit standard deviation (value noise on a lattice, cubic weights). Its nodes are kept from
// call to call: neighbours in a row of samples mostly lie in the same square.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : seed_(seed) {}
  double at(double x, double y) {
    const double fx = std::floor(x), fy = std::floor(y);
    if (!(fx == x_ && fy == y_)) {
      const auto i = static_cast<std::int64_t>(fx), j = static_cast<std::int64_t>(fy);
      x_ = fx, y_ = fy;
      nodes_ = {node(i, j), node(i + 1, j), node(i, j + 1), node(i + 1, j + 1)};
    }
    const auto fade = [](double t) { return t * t * (3 - 2 * t); };
    const double u = fade(x - fx), v = fade(y - fy);
    return 2.6 *
           ((1 - v) * ((1 - u) * nodes_[0] + u * nodes_[1]) + v * ((1 - u) * nodes_[2] + u * nodes_[3]));
  }

 private:
  double node(std::int64_t i, std::int64_t j) const {
    const auto bits = mix_bits(seed_ ^ mix_bits(static_cast<std::uint64_t>(i) * 0x9e3779b1U + 77 +
                                                mix_bits(static_cast<std::uint64_t>(j) + 12345)));
    return static_cast<double>(bits >> 11) * 0x1p-53 - 0.5;
  }
  std::uint64_t seed_;
  double x_ = std::numeric_limits<double>::quiet_NaN(), y_ = 0;  // corner of the square
  std::array<double, 4> nodes_ = {};
};

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

void blur(std::vector<float>& cells, std::int64_t w, std::int64_t h, double sd) {
  const auto half = static_cast<std::int64_t>(std::ceil(3.5 * sd));
  std::vector<float> mask;
  float total = 0;
  for (std::int64_t k = -half; k <= half; ++k) {
    mask.push_back(static_cast<float>(std::exp(-0.5 * static_cast<double>(k * k) / (sd * sd))));
    total += mask.back();
  }
  for (const bool across : {true, false}) {
    const std::vector<float> in = cells;
    for (std::int64_t y = 0; y < h; ++y)
      for (std::int64_t x = 0; x < w; ++x) {
        float sum = 0;
        for (std::int64_t k = -half; k <= half; ++k) {
          const auto u = across ? std::clamp<std::int64_t>(x + k, 0, w - 1) : x;
          const auto v = across ? y : std::clamp<std::int64_t>(y + k, 0, h - 1);
          sum += mask[static_cast<std::size_t>(k + half)] * in[static_cast<std::size_t>(v * w + u)];
        }
        cells[static_cast<std::size_t>(y * w + x)] = sum / total;
      }
  }
}

}  // namespace

RockImage render(const RockScene& scene) {
  Random random(scene.seed, "rock scene");
  const std::int64_t margin = 48;  // ground beyond the picture casts shadows into it
  const std::int64_t w = (scene.columns + 2 * margin) * kFine, h = (scene.rows + 2 * margin) * kFine;
  const auto bodies = make_bodies(scene, random);
  const auto bowls = make_bowls(scene, random);
  // One for each place where it is read, so that each keeps its own square.
  std::array<Noise, 4> rough = {Noise(scene.seed * 3 + 1), Noise(scene.seed * 3 + 1),
                                Noise(scene.seed * 3 + 1), Noise(scene.seed * 3 + 1)};
  Noise patchy(scene.seed * 3 + 2), small_patchy = patchy, bend(scene.seed * 3 + 3), cover_bend = bend;
  const double slope_x =
      -std::tan(to_radians(scene.slope).value) * std::cos(to_radians(scene.downhill).value);
  const double slope_y =
      -std::tan(to_radians(scene.slope).value) * std::sin(to_radians(scene.downhill).value);
  const double dune_angle = random.uniform(0, 2 * kPi);
  const auto coordinate = [&](std::int64_t i) {
    return (static_cast<double>(i) + 0.5) / kFine - 0.5 - static_cast<double>(margin);
  };
  const auto ground = [&](double x, double y) {
    double z = slope_x * x + slope_y * y;
    for (std::size_t octave = 0; octave < rough.size(); ++octave) {
      const double length = 40 / static_cast<double>(1 << octave);
      z += 0.35 * scene.roughness * length *
           rough[octave].at(x / length + 31 * static_cast<double>(octave), y / length);
    }
    if (scene.dunes > 0) {
      const double along = x * std::cos(dune_angle) + y * std::sin(dune_angle);
      const double phase = along / scene.dune_length + 0.8 * bend.at(x / 60, y / 60);
      const double saw = phase - std::floor(phase);  // a gentle windward side and a steep lee
      const double cover = std::clamp(cover_bend.at(x / 90 + 9, y / 90) + 0.6, 0.0, 1.0);
      z += cover * scene.dunes * (saw < 0.7 ? saw / 0.7 : (1 - saw) / 0.3);
    }
    return z;
  };
  std::vector<float> height(static_cast<std::size_t>(w * h));
  for (std::int64_t v = 0; v < h; ++v)
    for (std::int64_t u = 0; u < w; ++u)
      height[static_cast<std::size_t>(v * w + u)] = static_cast<float>(ground(coordinate(u), coordinate(v)));
  const auto stamp = [&](double x, double y, double reach,
                         const std::function<void(float&, double, double)>& change) {
    const auto low = [&](double c) {
      return static_cast<std::int64_t>((c + static_cast<double>(margin) - reach) * kFine);
    };
    const auto high = [&](double c) {
      return static_cast<std::int64_t>((c + static_cast<double>(margin) + reach + 1) * kFine);
    };
    for (auto v = std::max<std::int64_t>(0, low(y)); v < std::min(h, high(y)); ++v)
      for (auto u = std::max<std::int64_t>(0, low(x)); u < std::min(w, high(x)); ++u)
        change(height[static_cast<std::size_t>(v * w + u)], coordinate(u), coordinate(v));
  };
  for (const Bowl& bowl : bowls)
    stamp(bowl.x, bowl.y, 2.5 * bowl.radius,
          [&](float& z, double x, double y) { z += static_cast<float>(bowl_height(bowl, x, y)); });
  std::vector<Body> standing = bodies;
  for (const Body& body : standing)
    stamp(body.truth.x, body.truth.y, 1.0 * body.truth.diameter, [&](float& z, double x, double y) {
      const double top = height_of(body, x - body.truth.x, y - body.truth.y);
      if (top >= 0) z += static_cast<float>(top);
    });

  const double e = kPi / 2 - to_radians(scene.incidence).value, angle = to_radians(scene.sun_angle).value;
  const double sx = std::cos(e) * std::cos(angle), sy = std::cos(e) * std::sin(angle), sz = std::sin(e);
  // Highest samples of squares of 16, 64 and 256: a ray above a square is above the rest of it, too.
  struct Squares {
    int bits;  // of the side
    std::int64_t columns;
    std::vector<float> top;
  };
  std::vector<Squares> squares;
  for (const int bits : {4, 6, 8}) {
    Squares of{bits, ((w - 1) >> bits) + 1, {}};
    of.top.assign(static_cast<std::size_t>(of.columns * (((h - 1) >> bits) + 1)), -1e9F);
    for (std::int64_t v = 0; v < h; ++v)
      for (std::int64_t u = 0; u < w; ++u) {
        auto& top = of.top[static_cast<std::size_t>((v >> bits) * of.columns + (u >> bits))];
        top = std::max(top, height[static_cast<std::size_t>(v * w + u)]);
      }
    squares.push_back(std::move(of));
  }
  const float highest = std::ranges::max(squares.back().top);
  const double cx = std::cos(angle), cy = std::sin(angle), rise = std::tan(e) / kFine;
  // Steps from a position to the border of its square.
  const auto steps_within = [](double at, double speed, std::int64_t index, int bits) {
    const double from = static_cast<double>(index >> bits << bits) - 0.5;
    const double to = from + static_cast<double>(std::int64_t{1} << bits);
    return speed > 0 ? (to - at) / speed : speed < 0 ? (from - at) / speed : 1e9;
  };
  const double right = static_cast<double>(w) - 0.5, bottom = static_cast<double>(h) - 0.5;
  const auto shadowed = [&](std::int64_t u, std::int64_t v) {
    const double z0 = height[static_cast<std::size_t>(v * w + u)] + 1e-4;
    for (double t = 1;;) {
      const double z = z0 + t * rise, x = static_cast<double>(u) + t * cx,
                   y = static_cast<double>(v) + t * cy;
      if (!(x > -0.5 && y > -0.5 && x < right && y < bottom) || z > static_cast<double>(highest))
        return false;
      const auto pu = static_cast<std::int64_t>(x + 0.5), pv = static_cast<std::int64_t>(y + 0.5);
      const auto is_above = [&](const Squares& of) {
        return z > static_cast<double>(
                       of.top[static_cast<std::size_t>((pv >> of.bits) * of.columns + (pu >> of.bits))]);
      };
      int bits = 0;  // of the largest square that is below the ray
      for (const Squares& of : squares) {
        if (!is_above(of)) break;
        bits = of.bits;
      }
      if (bits > 0) {  // steps of two samples; the last one within the square is looked at again
        const double steps = std::min(steps_within(x, cx, pu, bits), steps_within(y, cy, pv, bits)) - 0.01;
        t += steps > 4 ? 2 * static_cast<double>(static_cast<std::int64_t>(steps / 2)) : 2;
        continue;
      }
      if (static_cast<double>(height[static_cast<std::size_t>(pv * w + pu)]) > z) return true;
      t += 1;
    }
  };
  std::vector<float> light(static_cast<std::size_t>(w * h));
  for (std::int64_t v = 1; v + 1 < h; ++v)
    for (std::int64_t u = 1; u + 1 < w; ++u) {
      const auto z = [&](std::int64_t a, std::int64_t b) {
        return static_cast<double>(height[static_cast<std::size_t>(b * w + a)]);
      };
      const double gx = 0.5 * kFine * (z(u + 1, v) - z(u - 1, v)),
                   gy = 0.5 * kFine * (z(u, v + 1) - z(u, v - 1));
      const double norm = std::sqrt(1 + gx * gx + gy * gy);
      const double cos_i = std::max(0.0, (sz - gx * sx - gy * sy) / norm), cos_e = 1 / norm;
      double lit = cos_i / sz;
      if (scene.lunar) lit = 0.5 * lit + 0.5 * (cos_i / (cos_i + cos_e)) * ((sz + 1) / sz);
      const double sunlight = cos_i > 0 && !shadowed(u, v) ? lit : 0;
      const double x = coordinate(u), y = coordinate(v);
      const double albedo =
          1 + scene.albedo * (patchy.at(x / 25, y / 25) + 0.5 * small_patchy.at(x / 6 + 50, y / 6));
      light[static_cast<std::size_t>(v * w + u)] = static_cast<float>(
          ((1 - scene.skylight) * sunlight + scene.skylight) * albedo * (1 - scene.haze) + scene.haze);
    }
  blur(light, w, h, scene.blur * kFine);
  RockImage image{Pixels(scene.columns, scene.rows), {}};
  Random noise(scene.seed, "noise");
  for (std::int64_t y = 0; y < scene.rows; ++y)
    for (std::int64_t x = 0; x < scene.columns; ++x) {
      double sum = 0;
      for (int dv = 0; dv < kFine; ++dv)
        for (int du = 0; du < kFine; ++du)
          sum += static_cast<double>(
              light[static_cast<std::size_t>(((y + margin) * kFine + dv) * w + (x + margin) * kFine + du)]);
      double value = scene.sunlit * (sum / (kFine * kFine) + noise.normal(0, scene.noise));
      if (scene.quantise) value = std::clamp(std::round(value), 0.0, 255.0);
      image.pixels(x, y) = static_cast<float>(value);
    }
  for (const Body& body : standing) image.rocks.push_back(body.truth);
  return image;
}

}  // namespace waymark::workflows
