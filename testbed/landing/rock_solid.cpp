// SPDX-License-Identifier: Apache-2.0
#include "testbed/landing/rock_solid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace waymark::testbed {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Ray in axes in which the outline of the rock is a unit circle about the origin and its top is at z = 1.
struct UnitRay {
  Eigen::Vector3d origin, along;
  UnitRay(const RockSolid& rock, const Eigen::Vector3d& from, const Eigen::Vector3d& towards) {
    const double c = std::cos(rock.turn), s = std::sin(rock.turn);
    const auto scaled = [&](const Eigen::Vector3d& p) {
      return Eigen::Vector3d((c * p.x() + s * p.y()) / rock.half_x, (c * p.y() - s * p.x()) / rock.half_y,
                             p.z() / rock.top);
    };
    origin = scaled(from - rock.foot);
    along = scaled(towards);
  }
};

// Converts a normal of the unit solid to a unit normal of the rock: normals scale inversely.
Eigen::Vector3d unscaled(const RockSolid& rock, const Eigen::Vector3d& n) {
  const double c = std::cos(rock.turn), s = std::sin(rock.turn), x = n.x() / rock.half_x,
               y = n.y() / rock.half_y;
  return Eigen::Vector3d(c * x - s * y, s * x + c * y, n.z() / rock.top).normalized();
}

struct RayInterval {
  double enter = -kInfinity, leave = kInfinity;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< where it enters, not of unit length
  bool any() const { return enter <= leave; }
};

RayInterval intersect_ball(const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
  const double a = d.squaredNorm(), b = o.dot(d), c = o.squaredNorm() - 1, root = b * b - a * c;
  if (!(root >= 0)) return {1, 0, {}};
  const double half = std::sqrt(root);
  const double enter = (-b - half) / a;
  return {enter, (-b + half) / a, o + enter * d};
}

RayInterval intersect_cylinder(const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
  RayInterval p;
  const double a = d.head<2>().squaredNorm(), b = o.head<2>().dot(d.head<2>()),
               c = o.head<2>().squaredNorm() - 1;
  if (a > 0) {
    const double root = b * b - a * c;
    if (!(root >= 0)) return {1, 0, {}};
    p.enter = (-b - std::sqrt(root)) / a, p.leave = (-b + std::sqrt(root)) / a;
    const Eigen::Vector3d at = o + p.enter * d;
    p.normal = {at.x(), at.y(), 0};
  } else if (c > 0) {
    return {1, 0, {}};
  }
  double low = (-1 - o.z()) / d.z(), high = (1 - o.z()) / d.z();
  if (d.z() == 0) return std::abs(o.z()) <= 1 ? p : RayInterval{1, 0, {}};
  if (low > high) std::swap(low, high);
  if (low > p.enter) p.enter = low, p.normal = {0, 0, d.z() < 0 ? 1.0 : -1.0};
  p.leave = std::min(p.leave, high);
  return p;
}

RayInterval intersect_planes(const RockSolid& rock, const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
  RayInterval p;
  for (const Eigen::Vector4f& plane : rock.planes) {
    const Eigen::Vector3d n = plane.head<3>().cast<double>();
    const double distance = double(plane.w()) - n.dot(o), speed = n.dot(d);
    if (speed == 0) {
      if (distance < 0) return {1, 0, {}};
      continue;
    }
    const double t = distance / speed;
    if (speed < 0 && t > p.enter) p.enter = t, p.normal = n;
    if (speed > 0) p.leave = std::min(p.leave, t);
    if (p.enter > p.leave) return p;
  }
  return p;
}

RayInterval intersect_solid(const RockSolid& rock, const Eigen::Vector3d& origin,
                            const Eigen::Vector3d& along) {
  const Eigen::Vector3d to_foot = rock.foot - origin;
  const double t = to_foot.dot(along) / along.squaredNorm();
  if ((to_foot - t * along).squaredNorm() > rock.reach * rock.reach) return {1, 0, {}};
  if (rock.shape == RockShape::irregular) return intersect_planes(rock, origin - rock.foot, along);
  const UnitRay ray(rock, origin, along);
  return rock.shape == RockShape::ellipsoid ? intersect_ball(ray.origin, ray.along)
                                            : intersect_cylinder(ray.origin, ray.along);
}

}  // namespace

std::optional<SolidHit> intersect(const RockSolid& rock, const Eigen::Vector3d& origin,
                                  const Eigen::Vector3d& along) {
  const RayInterval p = intersect_solid(rock, origin, along);
  if (!p.any() || p.enter < 0) return std::nullopt;
  return SolidHit{p.enter, rock.shape == RockShape::irregular ? Eigen::Vector3d(p.normal.normalized())
                                                              : unscaled(rock, p.normal)};
}

bool intersects(const RockSolid& rock, const Eigen::Vector3d& origin, const Eigen::Vector3d& along) {
  const RayInterval p = intersect_solid(rock, origin, along);
  return p.any() && p.leave > 0;
}

}  // namespace waymark::testbed
