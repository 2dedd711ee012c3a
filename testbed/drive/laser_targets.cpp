// SPDX-License-Identifier: Apache-2.0
#include "testbed/drive/laser_targets.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::testbed {

double StemSolid::radius(double above) const {
  if (!(above >= 0 && above < height)) return 0;
  // Taper of a paraboloid-like softwood stem above the butt (exponent 0.7), equal to dbh at 1.3 m.
  const double part = (height - above) / std::max(height - 1.3, 0.1);
  return dbh / 2 * std::pow(part, 0.7);
}

LaserTargets::LaserTargets(Terrain terrain, std::span<const RockSolid> rocks, std::vector<StemSolid> stems,
                           std::vector<Thicket> thickets)
    : terrain_(std::move(terrain)), rocks_(rocks), stems_(std::move(stems)), thickets_(std::move(thickets)) {
  const auto squares = [](std::int64_t nodes, double step) {
    return static_cast<std::int64_t>(static_cast<double>(nodes) * step / kSquare) + 1;
  };
  squares_ = Grid<std::vector<Target>>(squares(terrain_.heights().columns(), terrain_.step_x()),
                                       squares(terrain_.heights().rows(), terrain_.step_y()));
  const auto put = [&](TargetKind kind, std::size_t index, const Eigen::Vector3d& at, double reach) {
    const auto column = static_cast<std::int64_t>((at.x() - terrain_.x0()) / kSquare);
    const auto row = static_cast<std::int64_t>((terrain_.y0() - at.y()) / kSquare);
    if (!squares_.contains(column, row)) return;
    squares_(column, row)
        .push_back({kind, static_cast<std::uint32_t>(index), static_cast<float>(at.x()),
                    static_cast<float>(at.y()), static_cast<float>(reach)});
    widest_ = std::max(widest_, reach);
  };
  for (std::size_t i = 0; i < rocks_.size(); ++i) put(TargetKind::rock, i, rocks_[i].foot, rocks_[i].reach);
  for (std::size_t i = 0; i < stems_.size(); ++i) {
    const StemSolid& s = stems_[i];
    if (s.dbh > 0) put(TargetKind::stem, i, s.foot, s.dbh + 0.05 + 4 * s.lean.norm());
  }
  for (std::size_t i = 0; i < thickets_.size(); ++i)
    put(TargetKind::thicket, i, thickets_[i].centre, thickets_[i].radius);
}

std::vector<LaserTargets::Target> LaserTargets::near(const Eigen::Vector2d& at, double reach) const {
  std::vector<Target> found;
  const double x = at.x() - terrain_.x0(), y = terrain_.y0() - at.y(), wide = reach + widest_;
  const auto low = [](double v) { return std::max<std::int64_t>(0, static_cast<std::int64_t>(v / kSquare)); };
  const std::int64_t last_column = std::min(squares_.columns() - 1, low(std::max(0.0, x + wide)));
  const std::int64_t last_row = std::min(squares_.rows() - 1, low(std::max(0.0, y + wide)));
  for (std::int64_t r = low(y - wide); r <= last_row; ++r)
    for (std::int64_t c = low(x - wide); c <= last_column; ++c)
      for (const Target& t : squares_(c, r))
        if (std::hypot(double(t.x) - at.x(), double(t.y) - at.y()) - double(t.reach) <= reach)
          found.push_back(t);
  return found;
}

ForestSolids forest_solids(std::span<const StandingTree> trees, const ForestClutter& clutter,
                           const Terrain& terrain, std::uint64_t seed) {
  ForestSolids solids;
  Random lean(seed, "lean of stems"), branches(seed, "branches"), bushes(seed, "undergrowth");
  for (std::size_t i = 0; i < trees.size(); ++i) {
    const StandingTree& tree = trees[i];
    const auto of = static_cast<std::int64_t>(i);
    StemSolid stem{.foot = tree.foot, .dbh = tree.dbh, .height = tree.height};
    stem.lean = {lean.normal(0, 0.012), lean.normal(0, 0.012)};
    solids.stems.push_back(stem);
    // Dead branches become sparser upwards; foliage of a low living crown hides the stem.
    const bool branchy = branches.bernoulli(clutter.branchy);
    const double side = branches.uniform(0, 6.3), out = branches.uniform(0.2, 0.6);
    const double above = branches.uniform(1.2, 2.8), thick = branches.uniform(0.05, 0.5);
    if (tree.dbh > 0 && branchy)
      solids.thickets.push_back(
          {tree.foot + Eigen::Vector3d(out * std::cos(side), out * std::sin(side), above), out, thick,
           stem.felled_at, of});
    if (tree.crown_base < 2.5 && tree.crown_diameter > 0 && tree.height > 1)
      solids.thickets.push_back({tree.foot + Eigen::Vector3d(0, 0, std::max(1.0, tree.height / 3)),
                                 std::min(tree.crown_diameter / 2, tree.height / 2), 0.8, stem.felled_at,
                                 of});
  }
  const double width = double(terrain.heights().columns() - 1) * terrain.step_x();
  const double depth = double(terrain.heights().rows() - 1) * terrain.step_y();
  const std::uint64_t count = bushes.poisson(clutter.undergrowth * width * depth / 1e4);
  for (std::uint64_t i = 0; i < count; ++i) {
    const double x = terrain.x0() + bushes.uniform() * width, y = terrain.y0() - bushes.uniform() * depth;
    const double radius = bushes.uniform(0.4, 1.3), density = bushes.uniform(0.3, 2);
    if (const auto z = terrain.height(x, y))
      solids.thickets.push_back({{x, y, *z + 0.8 * radius}, radius, density});
  }
  return solids;
}

}  // namespace waymark::testbed
