// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "core/random.hpp"
#include "geo/canopy_source.hpp"
namespace waymark::test {

enum class Roof { flat, shed, gabled, hipped };

/// Part of a house in its own axes: [-length/2, length/2] x [-width/2, width/2] about `at`.
struct Wing {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double length = 12, width = 8;
  Roof roof = Roof::gabled;
  double eaves = 5, slope = 0.7;  // m, tangent

  /// Returns the height of the roof above the foot of the house; 0 beside the wing.
  double z(const Eigen::Vector2d& p) const {
    const double u = std::abs(p.x() - at.x()), v = std::abs(p.y() - at.y());
    if (u > length / 2 || v > width / 2) return 0;
    switch (roof) {
      case Roof::flat:
        return eaves;
      case Roof::shed:
        return eaves + slope * (p.y() - at.y() + width / 2);
      case Roof::gabled:
        return eaves + slope * (width / 2 - v);
      case Roof::hipped:
        return eaves + slope * std::min(width / 2 - v, length / 2 - u);
    }
    return 0;
  }
};

struct House {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double turn = 0;  // radians, counter-clockwise
  std::vector<Wing> wings;
  std::vector<Eigen::Vector2d> corners;  // own axes, counter-clockwise

  Eigen::Vector2d own(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d d = p - at;
    return {std::cos(turn) * d.x() + std::sin(turn) * d.y(), std::cos(turn) * d.y() - std::sin(turn) * d.x()};
  }
  Eigen::Vector2d placed(const Eigen::Vector2d& p) const {
    return at + Eigen::Vector2d(std::cos(turn) * p.x() - std::sin(turn) * p.y(),
                                std::sin(turn) * p.x() + std::cos(turn) * p.y());
  }
  double z(const Eigen::Vector2d& p) const {
    double top = 0;
    for (const Wing& wing : wings) top = std::max(top, wing.z(own(p)));
    return top;
  }
  double height() const {
    double top = 0;
    for (const Wing& w : wings)
      top = std::max(top, w.eaves + (w.roof == Roof::flat   ? 0
                                     : w.roof == Roof::shed ? w.slope * w.width
                                                            : w.slope * std::min(w.width, w.length) / 2));
    return top;
  }
  std::vector<Eigen::Vector2d> outline() const {
    std::vector<Eigen::Vector2d> ring;
    for (const Eigen::Vector2d& c : corners) ring.push_back(placed(c));
    return ring;
  }
  double reach() const {
    double far = 0;
    for (const Eigen::Vector2d& c : corners) far = std::max(far, c.norm());
    return far;
  }
};

inline House rectangle(const Eigen::Vector2d& at, double turn, double length, double width, Roof roof,
                       double eaves, double slope) {
  const double l = length / 2, w = width / 2;
  return {at, turn, {{{0, 0}, length, width, roof, eaves, slope}}, {{-l, -w}, {l, -w}, {l, w}, {-l, w}}};
}

/// An L: a wing along x and one along y at its eastern end; both flat, or gabled with ridges along them.
inline House angle(const Eigen::Vector2d& at, double turn, double length, double depth, double width,
                   bool flat, double eaves, double slope) {
  const double l = length / 2, w = width / 2;
  House house{at, turn, {}, {}};
  house.wings.push_back({{0, 0}, length, width, flat ? Roof::flat : Roof::gabled, eaves, slope});
  // The second wing's ridge runs along y: its own axes are exchanged by taking the slope across x.
  house.wings.push_back({{l - w, w + depth / 2}, width, depth, Roof::flat, eaves, 0});
  house.corners = {{-l, -w}, {l, -w}, {l, w + depth}, {l - width, w + depth}, {l - width, w}, {-l, w}};
  return house;
}

struct MadeTree {
  Eigen::Vector2d at;
  double height = 12, radius = 3;
};

struct MadePole {
  Eigen::Vector2d at;
  double height = 8, radius = 0.08;
};

struct MadeTown {
  double side = 120;  // m, from 0 to side along x and y
  double slope_x = 0.03, slope_y = -0.02;
  std::vector<House> houses = {};
  std::vector<MadeTree> trees = {};
  std::vector<MadePole> poles = {};

  double ground(double x, double y) const {
    return 300 + slope_x * x + slope_y * y + 0.3 * std::sin(x / 25) * std::cos(y / 31);
  }
  /// Returns the elevation on which a house stands: its floor is level.
  double foot(const House& house) const { return ground(house.at.x(), house.at.y()); }
};

/// Returns houses of all kinds on a jittered grid of 24 m with trees beside and touching them, and poles.
inline MadeTown made_town(std::uint64_t seed, double side = 120, bool with_houses = true) {
  Random random(seed, "made_town");
  MadeTown town{.side = side};
  const auto between = [&](double a, double b) { return a + (b - a) * random.uniform(); };
  int kind = 0;
  for (double y = 16; y + 16 <= side; y += 24)
    for (double x = 16; x + 16 <= side; x += 24, ++kind) {
      const Eigen::Vector2d at(x + between(-2, 2), y + between(-2, 2));
      const double turn = between(0, std::numbers::pi), eaves = between(3, 9), slope = between(0.35, 1);
      const double length = between(9, 15), width = between(6, 9);
      House house;
      switch (kind % 6) {
        case 0:
          house = rectangle(at, turn, length, width, Roof::gabled, eaves, slope);
          break;
        case 1:
          house = rectangle(at, turn, length, width, Roof::flat, eaves, 0);
          break;
        case 2:
          house = angle(at, turn, length, between(4, 6), between(5, 7), true, eaves, 0);
          break;
        case 3:
          house = rectangle(at, turn, length, width, Roof::hipped, eaves, slope);
          break;
        case 4:
          house = rectangle(at, turn, length, width, Roof::shed, eaves, between(0.1, 0.4));
          break;
        default:
          house = angle(at, turn, length, between(4, 6), between(5, 7), false, eaves, slope);
      }
      const double reach = house.reach();
      // One tree leans on the roof of every second house, others stand beside.
      for (int t = 0; t < 3; ++t) {
        const double azimuth = between(0, 2 * std::numbers::pi), radius = between(1.5, 3.5);
        const double away =
            t == 0 && kind % 2 == 0 ? house.corners[0].norm() + 0.5 * radius : reach + radius + 1;
        const double to = t == 0 && kind % 2 == 0 ? std::atan2(house.placed(house.corners[0]).y() - at.y(),
                                                               house.placed(house.corners[0]).x() - at.x())
                                                  : azimuth;
        town.trees.push_back(
            {at + away * Eigen::Vector2d(std::cos(to), std::sin(to)), between(5, 16), radius});
      }
      if (with_houses) town.houses.push_back(house);
    }
  for (int p = 0; p < int(side * side / 400); ++p) {
    const MadePole pole{{between(3, side - 3), between(3, side - 3)}, between(4, 10), between(0.06, 0.15)};
    const auto clear = [&](const auto& thing, double reach) { return (thing.at - pole.at).norm() > reach; };
    if (std::ranges::all_of(town.houses, [&](const House& h) { return clear(h, h.reach() + 2); }) &&
        std::ranges::all_of(town.trees, [&](const MadeTree& t) { return clear(t, t.radius + 2); }) &&
        std::ranges::all_of(town.poles, [&](const MadePole& q) { return clear(q, 4); }))
      town.poles.push_back(pole);
  }
  return town;
}

struct TownReturn {
  double x = 0, y = 0, z = 0;
  std::uint8_t classification = 1, number = 1, of = 1;
};

struct ScanRules {
  double density = 8;  // pulses per m2
  double range_sd = 0.03, across_sd = 0.08;
  double max_angle = 0.35;  // rad from the vertical, of two flight lines
  bool returns_known = true, classified = true;
};

/// Simulates two flight lines over a town: slanted pulses, up to four returns each. A pulse in a crown
/// returns after an exponential depth and goes on with probability 0.55.
inline std::vector<TownReturn> scan_town(const MadeTown& town, const ScanRules& rules, std::uint64_t seed) {
  Random random(seed, "scan_town");
  constexpr double kStep = 0.1, kBucket = 6, kCrownDepth = 0.6, kThrough = 0.55, kApart = 1;
  const auto count = static_cast<std::int64_t>(town.side / kBucket) + 1;
  struct Bucket {
    std::vector<const House*> houses;
    std::vector<const MadeTree*> trees;
    std::vector<const MadePole*> poles;
    double top = 0;
  };
  Grid<Bucket> buckets(count, count);
  const auto enter = [&](const Eigen::Vector2d& at, double reach, double top, auto&& add) {
    for (std::int64_t r = 0; r < count; ++r)
      for (std::int64_t c = 0; c < count; ++c) {
        const Eigen::Vector2d middle((double(c) + 0.5) * kBucket, (double(r) + 0.5) * kBucket);
        if ((middle - at).cwiseAbs().maxCoeff() > reach + kBucket + 4) continue;
        add(buckets(c, r));
        buckets(c, r).top = std::max(buckets(c, r).top, top);
      }
  };
  for (const House& h : town.houses)
    enter(h.at, h.reach(), h.height() + 1, [&](Bucket& b) { b.houses.push_back(&h); });
  for (const MadeTree& t : town.trees)
    enter(t.at, t.radius, t.height, [&](Bucket& b) { b.trees.push_back(&t); });
  for (const MadePole& p : town.poles) enter(p.at, 1, p.height, [&](Bucket& b) { b.poles.push_back(&p); });

  std::vector<TownReturn> returns;
  const double spacing = 1 / std::sqrt(rules.density);
  for (double py = spacing / 2; py < town.side; py += spacing)
    for (double px = spacing / 2; px < town.side; px += spacing) {
      const double x0 = px + spacing * (random.uniform() - 0.5), y0 = py + spacing * (random.uniform() - 0.5);
      const double angle = rules.max_angle * (2 * random.uniform() - 1), turn = 0.4;
      const Eigen::Vector2d lean = std::tan(angle) * Eigen::Vector2d(std::cos(turn), std::sin(turn));
      const auto index = [&](double v) {
        return std::clamp<std::int64_t>(std::int64_t(v / kBucket), 0, count - 1);
      };
      const Bucket& near = buckets(index(x0), index(y0));
      std::vector<TownReturn> pulse;
      const double ground = town.ground(x0, y0);
      double last = 1e9;
      bool stopped = false;
      const auto record = [&](const Eigen::Vector2d& at, double z, int kind) {
        pulse.push_back({at.x() + rules.across_sd * random.normal(),
                         at.y() + rules.across_sd * random.normal(), z + rules.range_sd * random.normal(),
                         static_cast<std::uint8_t>(kind), 1, 1});
        last = z;
      };
      for (double up = near.top; up > 0 && !stopped; up -= kStep) {
        const Eigen::Vector2d at = Eigen::Vector2d(x0, y0) + up * lean;
        const double z = ground + up;
        for (const MadePole* p : near.poles)
          if (!stopped && (at - p->at).norm() < p->radius &&
              z < town.ground(p->at.x(), p->at.y()) + p->height)
            record(at, z, 1), stopped = true;
        for (const House* h : near.houses)
          if (const double top = town.foot(*h) + h->z(at); !stopped && h->z(at) > 0 && z <= top)
            record(at, top - z < 2 * kStep ? top : z, 1), stopped = true;  // else on a wall
        for (const MadeTree* t : near.trees) {
          const double foot = town.ground(t->at.x(), t->at.y()), half = 0.4 * t->height;
          const double v = (z - foot - t->height + half) / half, u = (at - t->at).norm() / t->radius;
          if (stopped || u * u + v * v > 1 || last - z < kApart || pulse.size() >= 3) continue;
          if (random.uniform() > 1 - std::exp(-kStep / kCrownDepth)) continue;
          record(at, z, 1);
          stopped = random.uniform() > kThrough;
        }
      }
      if (!stopped) record({x0, y0}, ground, 2);
      for (std::size_t i = 0; i < pulse.size(); ++i) {
        if (!rules.classified) pulse[i].classification = 1;
        pulse[i].number = static_cast<std::uint8_t>(rules.returns_known ? i + 1 : 0);
        pulse[i].of = static_cast<std::uint8_t>(rules.returns_known ? pulse.size() : 0);
        if (pulse[i].x >= 0 && pulse[i].y >= 0 && pulse[i].x < town.side && pulse[i].y < town.side)
          returns.push_back(pulse[i]);
      }
    }
  return returns;
}

/// A scanned town over its true ground.
class TownCanopy final : public CanopySource {
 public:
  TownCanopy(const MadeTown& town, std::vector<TownReturn> returns, double density)
      : town_(town), returns_(std::move(returns)), density_(density) {
    double cell = 2;
    for (const double usual : {1.0, 0.5, 0.25})
      if (usual >= 1 / std::sqrt(density)) cell = usual;
    grid_.where.dx = cell, grid_.where.dy = -cell;
    grid_.where.x0 = cell / 2, grid_.where.y0 = town.side - cell / 2;
    grid_.columns = grid_.rows = std::int64_t(std::ceil(town.side / cell));
  }
  const GridGeometry& geometry() const override { return grid_; }
  Grid<float> read(const Window& w) const override { return Grid<float>(w.columns, w.rows, kNoCanopy); }
  double ground_elevation(std::int64_t c, std::int64_t r) const override {
    return town_.ground(grid_.where.x(double(c)), grid_.where.y(double(r)));
  }
  Grid<std::uint8_t> forest_types(const Window&) const override { return {}; }
  double point_density() const override { return density_; }
  const std::string& name() const override { return name_; }
  void visit_surface(const Window& w, const std::function<void(const SurfacePoint&)>& use) const override {
    for (const TownReturn& p : returns_) {
      const auto c = std::llround(grid_.where.column(p.x)), r = std::llround(grid_.where.row(p.y));
      if (!w.contains(c, r)) continue;
      use({p.x - grid_.where.x0, p.y - grid_.where.y0, p.z, float(p.z - town_.ground(p.x, p.y)), p.number,
           p.of, p.classification});
    }
  }
  /// Returns a position of the town of one in the axes of the survey.
  Eigen::Vector2d in_town(const Eigen::Vector2d& p) const {
    return p + Eigen::Vector2d(grid_.where.x0, grid_.where.y0);
  }
  Window all() const { return {0, 0, grid_.columns, grid_.rows}; }

 private:
  MadeTown town_;
  std::vector<TownReturn> returns_;
  double density_;
  GridGeometry grid_;
  std::string name_ = "made_town";
};

}  // namespace waymark::test
