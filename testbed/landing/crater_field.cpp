// SPDX-License-Identifier: Apache-2.0
#include "testbed/landing/crater_field.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <numbers>

#include "core/random.hpp"
#include "core/solve.hpp"
#include "testbed/landing/crater_profile.hpp"

namespace waymark::testbed {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kEquilibrium = 0.08;  // of N(> D) = 0.08 D^-2 per m^2 (Trask 1966)

double smooth_step(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double soft_max(double a, double b, double softness) {
  return 0.5 * (a + b + std::sqrt((a - b) * (a - b) + softness * softness));
}

// Rim radius over azimuth relative to the ellipse: a few harmonics, stronger for fresh craters.
std::array<double, 65> rim_wobble(const CraterPlan& crater) {
  Random random(crater.seed);
  std::array<double, 65> factor{};
  factor.fill(1);
  const double strength = 0.02 + 0.02 * random.uniform();
  for (int harmonic = 3; harmonic <= 8; ++harmonic) {
    const double size = strength * random.normal() / std::sqrt(harmonic), phase = random.uniform(0, 2 * kPi);
    for (std::size_t i = 0; i < factor.size(); ++i)
      factor[i] += size * std::cos(harmonic * double(i) * kPi / 32 + phase);
  }
  return factor;
}

// Map offsets in units of the rim ellipse: 0.5 on the rim.
struct EllipseFrame {
  double cos, sin, major, minor;
  explicit EllipseFrame(const CraterPlan& c)
      : cos(std::cos(c.turn)), sin(std::sin(c.turn)), major(c.major), minor(c.minor) {}
  Eigen::Vector2d unit(double dx, double dy) const {
    return {(cos * dx + sin * dy) / major, (cos * dy - sin * dx) / minor};
  }
  Eigen::Vector2d metres(double angle, double r) const {
    const double u = r * major * std::cos(angle), v = r * minor * std::sin(angle);
    return {cos * u - sin * v, sin * u + cos * v};
  }
};

// Plane through the terrain about the crater: height at its centre and slopes.
Eigen::Vector3d plane_around(const Grid<float>& heights, const NodeGrid& nodes, const CraterPlan& crater,
                             const EllipseFrame& frame) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const double r : {0.45, 0.55, 0.65})
    for (int k = 0; k < 24; ++k) {
      const Eigen::Vector2d d = frame.metres(k * kPi / 12, r);
      const auto i =
          std::clamp<std::int64_t>(std::lround(nodes.column(crater.east + d.x())), 0, nodes.columns - 1);
      const auto j =
          std::clamp<std::int64_t>(std::lround(nodes.row(crater.north + d.y())), 0, nodes.rows - 1);
      const Eigen::Vector3d row(1, d.x(), d.y());
      normal += row * row.transpose();
      right += row * double(heights(i, j));
    }
  return solve_symmetric(normal, right);
}

// Secondary craters of a distant impact: along a line, elongated along it, half as deep.
void add_secondaries(std::vector<CraterPlan>& plans, const SiteModel& ground, std::uint64_t seed) {
  const CraterPopulation& law = ground.craters;
  const CraterProfiles& profiles = CraterProfiles::instance();
  Random random(seed, "secondary craters");
  for (int cluster = 0; cluster < law.clusters; ++cluster) {
    const double x = ground.east + random.uniform(-0.5, 0.5) * ground.width;
    const double y = ground.north + random.uniform(-0.5, 0.5) * ground.height;
    const double azimuth = random.uniform(-kPi / 2, kPi / 2), wear = random.uniform(0.3, 1);
    const double size = std::min(law.min_diameter * random.uniform(1, 3), law.max_diameter);
    const auto count = 8 + random.uniform_index(25);
    for (std::uint64_t i = 0; i < count; ++i) {
      const double along = 12 * size * random.normal(), across = 3 * size * random.normal();
      const double diameter = std::min(size * random.log_uniform(1, 2.5), law.max_diameter);
      const double ratio = random.uniform(1 - 1.5 * law.elongation, 1);
      plans.push_back({.east = x + along * std::cos(azimuth) - across * std::sin(azimuth),
                       .north = y + along * std::sin(azimuth) + across * std::cos(azimuth),
                       .major = diameter / std::sqrt(ratio),
                       .minor = diameter * std::sqrt(ratio),
                       .turn = azimuth,
                       .age = profiles.age(std::lerp(0.05, 0.12, wear)),
                       .infill = 0,
                       .seed = static_cast<std::uint32_t>(random.bits())});
    }
  }
}

}  // namespace

std::vector<CraterPlan> draw_craters(const SiteModel& ground, std::uint64_t seed) {
  const CraterPopulation& law = ground.craters;
  const CraterProfiles& profiles = CraterProfiles::instance();
  std::vector<CraterPlan> plans;
  if (!(law.density > 0)) return plans;
  Random random(seed, "craters");
  // Diameters in descending order along the cumulative distribution; the area grows with the reach of the
  // crater.
  const double margin = law.max_diameter;
  const double width = ground.width + 2 * margin, height = ground.height + 2 * margin;
  const auto expected = [&](double d) {
    return law.density * kEquilibrium * std::pow(d, -law.slope) * width * height;
  };
  for (double count = expected(law.max_diameter);;) {
    count -= std::log(1 - random.uniform());  // waiting time of a Poisson process
    const double diameter = std::pow(count / (law.density * kEquilibrium * width * height), -1 / law.slope);
    if (diameter < law.min_diameter) break;
    CraterPlan plan;
    plan.east = ground.east + random.uniform(-0.5, 0.5) * width;
    plan.north = ground.north + random.uniform(-0.5, 0.5) * height;
    const double ratio = 1 - law.elongation * std::pow(random.uniform(), 2);
    plan.major = diameter / std::sqrt(ratio);
    plan.minor = diameter * std::sqrt(ratio);
    plan.turn = random.uniform(-kPi / 2, kPi / 2);
    const double wear =
        random.bernoulli(law.fresh) ? random.uniform(0.85, 1) : std::pow(random.uniform(), 1.2) * 0.85;
    plan.age = profiles.age(std::lerp(law.oldest_depth, CraterProfiles::kFreshDepth, wear));
    plan.infill = random.bernoulli(law.infill) ? random.uniform(0.1, 0.5) : 0;
    plan.seed = static_cast<std::uint32_t>(random.bits());
    if (std::abs(plan.east - ground.east) < ground.width / 2 + CraterProfiles::kReach * diameter &&
        std::abs(plan.north - ground.north) < ground.height / 2 + CraterProfiles::kReach * diameter)
      plans.push_back(plan);
  }
  add_secondaries(plans, ground, seed);
  const auto time = [](const CraterPlan& p) { return p.age * p.major * p.minor; };
  std::stable_sort(plans.begin(), plans.end(),
                   [&](const auto& a, const auto& b) { return time(a) > time(b); });
  return plans;
}

void excavate(Grid<float>& heights, const NodeGrid& nodes, const CraterPlan& crater) {
  const CraterProfiles& profiles = CraterProfiles::instance();
  const EllipseFrame frame(crater);
  const double diameter = crater.diameter(), reach = CraterProfiles::kReach * crater.major;
  const auto first = [](double x) {
    return std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil(x)));
  };
  const std::int64_t c0 = first(nodes.column(crater.east - reach)),
                     r0 = first(nodes.row(crater.north + reach));
  const auto c1 = std::min(nodes.columns - 1, static_cast<std::int64_t>(nodes.column(crater.east + reach)));
  const auto r1 = std::min(nodes.rows - 1, static_cast<std::int64_t>(nodes.row(crater.north - reach)));
  if (c1 < c0 || r1 < r0) return;

  const Eigen::Vector3d plane = plane_around(heights, nodes, crater, frame);
  const std::array<double, 65> wobble = rim_wobble(crater);
  // Profile of this age, tabulated every 1/128 of a diameter.
  std::array<double, static_cast<std::size_t>(CraterProfiles::kReach * 128) + 2> profile{};
  const double fill = profiles.height(crater.age, 0) + crater.infill * profiles.depth(crater.age);
  for (std::size_t i = 0; i < profile.size(); ++i) {
    profile[i] = profiles.height(crater.age, double(i) / 128);
    if (crater.infill > 0 && i < 64) profile[i] = soft_max(profile[i], fill, 0.01);
    profile[i] *= diameter;
  }
  for (std::int64_t j = r0; j <= r1; ++j)
    for (std::int64_t i = c0; i <= c1; ++i) {
      const double dx = nodes.x(i) - crater.east, dy = nodes.y(j) - crater.north;
      const Eigen::Vector2d unit = frame.unit(dx, dy);
      double r = unit.norm();
      if (r >= CraterProfiles::kReach) continue;
      // Only the rim is irregular, not the bowl and the distal ejecta.
      if (const double rim = 4 * r * r * std::exp(1 - 4 * r * r); rim > 0.02) {
        const double azimuth = (std::atan2(unit.y(), unit.x()) + kPi) * 32 / kPi;
        const auto k = std::min<std::size_t>(static_cast<std::size_t>(azimuth), 63);
        r /= 1 + rim * (std::lerp(wobble[k], wobble[k + 1], azimuth - double(k)) - 1);
      }
      const double place = std::min(r * 128, double(profile.size()) - 1.001);
      const auto m = static_cast<std::size_t>(place);
      const double added = std::lerp(profile[m], profile[m + 1], place - double(m));
      const double levelled = 0.9 * smooth_step(0.65, 0.42, r);
      const double plain = plane.x() + plane.y() * dx + plane.z() * dy;
      heights(i, j) = static_cast<float>(std::lerp(double(heights(i, j)), plain, levelled) + added);
    }
}

std::optional<TrueCrater> measure_crater(const Terrain& terrain, const CraterPlan& crater) {
  const EllipseFrame frame(crater);
  std::vector<double> rim, floor;
  for (int k = 0; k < 36; ++k) {
    double highest = -1e30;
    for (const double r : {0.46, 0.48, 0.5, 0.52, 0.54}) {
      const Eigen::Vector2d d = frame.metres(k * kPi / 18, r);
      const auto h = terrain.height(crater.east + d.x(), crater.north + d.y());
      if (!h) return std::nullopt;
      highest = std::max(highest, *h);
    }
    rim.push_back(highest);
    for (const double r : {0.03, 0.08, 0.14, 0.2}) {
      const Eigen::Vector2d d = frame.metres(k * kPi / 18, r);
      floor.push_back(*terrain.height(crater.east + d.x(), crater.north + d.y()));
    }
  }
  std::nth_element(rim.begin(), rim.begin() + 18, rim.end());
  std::nth_element(floor.begin(), floor.begin() + 14, floor.end());
  const double made = CraterProfiles::instance().depth(crater.age) * crater.diameter() * (1 - crater.infill);
  const double from_north = std::remainder(kPi / 2 - crater.turn, kPi);
  return TrueCrater{.position = {crater.east, crater.north, rim[18]},
                    .major = crater.major,
                    .minor = crater.minor,
                    .orientation = from_north,
                    .depth = rim[18] - floor[14],
                    .formation_depth = made,
                    .age = crater.age};
}

}  // namespace waymark::testbed
