// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "testbed/landing/rock_field.hpp"

namespace waymark::testbed {
namespace {

constexpr double kPi = std::numbers::pi;

// Outline of the planes at ground level, as seen from the origin, which must be inside.
double outline_radius(const std::vector<Eigen::Vector4f>& planes, double azimuth) {
  const double x = std::cos(azimuth), y = std::sin(azimuth);
  double r = 1e9;
  for (const auto& p : planes) {
    const double speed = double(p.x()) * x + double(p.y()) * y;
    if (speed > 0) r = std::min(r, double(p.w()) / speed);
  }
  return r;
}

double height_at(const std::vector<Eigen::Vector4f>& planes, double x, double y) {
  double z = 1e9;
  for (const auto& p : planes)
    if (p.z() > 1e-3F)
      z = std::min(z, (double(p.w()) - double(p.x()) * x - double(p.y()) * y) / double(p.z()));
  return z;
}

struct Outline {
  double area = 0;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  double longest = 0;
};
Outline outline(const std::vector<Eigen::Vector4f>& planes) {
  constexpr int kSteps = 96;
  Outline o;
  for (int i = 0; i < kSteps; ++i) {
    const double a = 2 * kPi * i / kSteps, r = outline_radius(planes, a);
    o.area += r * r * kPi / kSteps;
    o.middle += Eigen::Vector2d(std::cos(a), std::sin(a)) * (r * r * r * 2 * kPi / (3 * kSteps));
    o.longest = std::max(o.longest, r);
  }
  o.middle /= o.area;
  return o;
}

// Height of the highest point. The upper surface is concave, so grids refined about the best point find it;
// accurate to a hundredth of the reach.
double peak(const std::vector<Eigen::Vector4f>& planes, double reach) {
  double best = -1e9, x = 0, y = 0;
  for (double half = reach; half > reach / 50; half /= 3) {
    const double middle_x = x, middle_y = y;
    for (int j = -3; j <= 3; ++j)
      for (int i = -3; i <= 3; ++i) {
        const double at_x = middle_x + half * i / 3, at_y = middle_y + half * j / 3;
        if (const double z = height_at(planes, at_x, at_y); z > best) best = z, x = at_x, y = at_y;
      }
  }
  return best;
}

// Convex rock from tangent planes of a ball, some pushed in, scaled to the requested outline and height.
void carve_rock(RockSolid& rock, Random& random) {
  auto& planes = rock.planes;
  planes.clear();
  const int sides = 6 + int(random.uniform_index(5));
  for (int i = 0; i < sides; ++i) {
    const double a = 2 * kPi * (i + random.uniform(-0.35, 0.35)) / sides, lean = random.uniform(-0.15, 0.55);
    planes.push_back(
        Eigen::Vector3d(std::cos(a), std::sin(a), lean).normalized().cast<float>().homogeneous());
    planes.back().w() = static_cast<float>(random.uniform(0.72, 1));
  }
  const int tops = 3 + int(random.uniform_index(4));
  for (int i = 0; i < tops; ++i) {
    const double a = random.uniform(0, 2 * kPi), lean = random.uniform(0.7, 2.5);
    planes.push_back(
        Eigen::Vector3d(std::cos(a), std::sin(a), lean).normalized().cast<float>().homogeneous());
    planes.back().w() = static_cast<float>(random.uniform(0.7, 0.95));
  }
  planes.push_back({0, 0, -1, 1});
  planes.push_back({0, 0, 1, 1});
  const auto scale = [&planes](double x, double y, double z) {
    for (auto& p : planes) {
      Eigen::Vector3d n = p.head<3>().cast<double>();
      n = Eigen::Vector3d(n.x() / x, n.y() / y, n.z() / z);
      const double length = n.norm();
      p.head<3>() = (n / length).cast<float>();
      p.w() = static_cast<float>(double(p.w()) / length);
    }
  };
  scale(rock.half_x, rock.half_y, 1);
  const Outline shape = outline(planes);
  for (auto& p : planes)
    p.w() -= static_cast<float>(double(p.x()) * shape.middle.x() + double(p.y()) * shape.middle.y());
  const double grow = std::sqrt(kPi * rock.half_x * rock.half_y / shape.area);
  scale(grow, grow, rock.top / peak(planes, shape.longest));
  const float c = static_cast<float>(std::cos(rock.turn)), s = static_cast<float>(std::sin(rock.turn));
  for (auto& p : planes) p.head<2>() = Eigen::Vector2f(c * p.x() - s * p.y(), s * p.x() + c * p.y());
  rock.reach = 1.05 * std::hypot(outline(planes).longest * 1.25, rock.top);
}

}  // namespace

RockSolid make_rock(RockShape shape, double width, double height, Random& random) {
  RockSolid rock;
  rock.shape = shape;
  const double ratio = random.uniform(0.7, 1);
  rock.half_x = width / 2 / std::sqrt(ratio);
  rock.half_y = width / 2 * std::sqrt(ratio);
  rock.turn = random.uniform(0, kPi);
  rock.top = height;
  rock.reach = shape == RockShape::cylinder ? std::hypot(rock.half_x, height) : std::max(rock.half_x, height);
  rock.brightness = std::exp(random.normal(0.08, 0.15));
  if (shape == RockShape::irregular) carve_rock(rock, random);
  return rock;
}

}  // namespace waymark::testbed
