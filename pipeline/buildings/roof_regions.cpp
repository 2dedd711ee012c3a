// SPDX-License-Identifier: Apache-2.0
#include "pipeline/buildings/roof_regions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace waymark::pipeline {
namespace {

// Half the side of the neighbourhood of a cell, m. Few returns need a wide one. Rasters need a wider one:
// crowns are smooth in them, but their tops, spheres of 5 m radius, depart from a plane by 0.26 m over 5 m.
// Near ridges and on narrow roofs a small one has more smooth cells.
constexpr double kReach = 1.25, kReachOfDense = 0.75, kReachOfRaster = 2.5;
constexpr double kDense = 5;  // first returns per m2
constexpr std::int64_t kMinDilation =
    2;                               // cells: the rough ridge lies between the smooth cells of both sides
constexpr double kMaxSlope = 2.8;    // 70 degrees; steeper planes are walls
constexpr double kMinCosine = 0.94;  // of the angle between a smooth cell and the plane it joins: 20 degrees
constexpr double kRefit = 1.5;       // planes are fitted again when they have grown by this factor
constexpr int kEnclosing = 5;        // of eight neighbours
constexpr int kBesideEmpty = 3;      // of eight neighbours of a cell without returns have returns of the roof
constexpr std::int32_t kNone = -1;

std::int64_t reach_of(const RoofCells& cells) {
  const double reach = cells.density >= kDense ? kReachOfDense : cells.density > 0 ? kReach : kReachOfRaster;
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(reach / std::max(cells.width, cells.height)));
}

std::int64_t dilation_of(const RoofCells& cells) {
  return std::max(kMinDilation, reach_of(cells));
}

struct SmoothCell {
  double rms = std::numeric_limits<double>::infinity();
  double slope_x = 0, slope_y = 0;
  bool is_smooth() const { return rms < std::numeric_limits<double>::infinity(); }
};

/// Cells of a window by their planes.
class Growing {
 public:
  Growing(const RoofCells& cells, const RoofRules& rules)
      : all_(cells),
        rules_(rules),
        reach_(reach_of(cells)),
        smooth_(cells.window.columns, cells.window.rows),
        group_(cells.window.columns, cells.window.rows, kNone),
        plane_(cells.window.columns, cells.window.rows, kNone) {}

  std::vector<RoofGroup> run() {
    measure_smoothness();
    mark_candidates();
    std::vector<RoofGroup> groups;
    for (std::int64_t r = 0; r < group_.rows(); ++r)
      for (std::int64_t c = 0; c < group_.columns(); ++c)
        if (group_(c, r) == kCandidate) groups.push_back(group_at({c, r}));
    return groups;
  }

 private:
  static constexpr std::int32_t kCandidate = -2;

  bool has_high(std::int64_t c, std::int64_t r) const { return all_.cells(c, r).high.count > 0; }

  /// Returns whether a cell may belong to a roof: it has returns, or none of any kind among cells that have.
  bool is_open(std::int64_t c, std::int64_t r) const {
    const RoofCell& cell = all_.cells(c, r);
    if (cell.high.count > 0) return true;
    if (cell.low > 0 || cell.plant > 0) return false;
    int beside = 0;
    around({c, r}, 1, [&](const RoofCellAt& near) { beside += has_high(near.column, near.row); });
    return beside >= kBesideEmpty;
  }

  /// `at` is a copy: `visit` may add to the list that it comes from.
  template <class Visit>
  void around(const RoofCellAt at, std::int64_t reach, Visit&& visit) const {
    for (std::int64_t r = std::max<std::int64_t>(0, at.row - reach);
         r <= std::min(group_.rows() - 1, at.row + reach); ++r)
      for (std::int64_t c = std::max<std::int64_t>(0, at.column - reach);
           c <= std::min(group_.columns() - 1, at.column + reach); ++c)
        visit(RoofCellAt{c, r});
  }

  void measure_smoothness() {
    for (std::int64_t r = 0; r < group_.rows(); ++r)
      for (std::int64_t c = 0; c < group_.columns(); ++c) {
        if (!has_high(c, r)) continue;
        const CellSums& own = all_.cells(c, r).high;
        PlaneSums sums(all_.centre(c, r), static_cast<double>(own.z / own.count) / 1000);
        around({c, r}, reach_, [&](const RoofCellAt& near) {
          sums.add(all_.cells(near.column, near.row).high, all_.centre(near.column, near.row));
        });
        const auto plane = sums.fit();
        if (!plane || !(plane->rms <= rules_.roughness) ||
            !(std::hypot(plane->slope_x, plane->slope_y) <= kMaxSlope))
          continue;
        smooth_(c, r) = {plane->rms, plane->slope_x, plane->slope_y};
      }
  }

  void mark_candidates() {
    for (std::int64_t r = 0; r < group_.rows(); ++r)
      for (std::int64_t c = 0; c < group_.columns(); ++c)
        if (smooth_(c, r).is_smooth())
          around({c, r}, dilation_of(all_), [&](const RoofCellAt& near) {
            if (is_open(near.column, near.row)) group_(near.column, near.row) = kCandidate;
          });
  }

  RoofGroup group_at(const RoofCellAt& first) {
    const std::int32_t own = groups_++;
    std::vector<RoofCellAt> members{first};
    group_(first.column, first.row) = own;
    std::int64_t left = first.column, right = first.column, top = first.row, bottom = first.row;
    for (std::size_t i = 0; i < members.size(); ++i) {
      const RoofCellAt at = members[i];
      left = std::min(left, at.column), right = std::max(right, at.column);
      top = std::min(top, at.row), bottom = std::max(bottom, at.row);
      around(at, 1, [&](const RoofCellAt& near) {
        std::int32_t& of = group_(near.column, near.row);
        if (of != kCandidate) return;
        of = own;
        members.push_back(near);
      });
    }
    RoofGroup group{.box = {left, top, right - left + 1, bottom - top + 1}};
    const std::int64_t margin = roof_margin(all_);
    group.cut = left < margin || top < margin || right >= group_.columns() - margin ||
                bottom >= group_.rows() - margin;
    const double across = std::max(static_cast<double>(group.box.columns) * all_.width,
                                   static_cast<double>(group.box.rows) * all_.height);
    if (across > rules_.max_extent) return group;
    grow_planes(members, own, group);
    return group;
  }

  // Planes within a group, the smoothest seed first.
  void grow_planes(const std::vector<RoofCellAt>& members, std::int32_t group, RoofGroup& into) {
    std::vector<RoofCellAt> seeds;
    for (const RoofCellAt& at : members)
      if (smooth_(at.column, at.row).is_smooth()) seeds.push_back(at);
    std::ranges::sort(seeds, {}, [&](const RoofCellAt& at) {
      return std::tuple(smooth_(at.column, at.row).rms, at.row, at.column);
    });
    const std::int32_t first = planes_;
    std::vector<RoofPlane> planes;
    std::vector<std::vector<RoofCellAt>> cells;
    for (const RoofCellAt& seed : seeds) {
      if (plane_(seed.column, seed.row) != kNone) continue;
      auto [plane, grown] = grow(seed, group);
      const double area = static_cast<double>(grown.size()) * all_.width * all_.height;
      if (!plane || area < rules_.min_plane_area || plane->rms > rules_.roughness) {
        for (const RoofCellAt& at : grown) plane_(at.column, at.row) = kNone;
        continue;
      }
      ++planes_;
      planes.push_back(*plane);
      cells.push_back(std::move(grown));
    }
    join(planes, cells, first, members, into);
  }

  std::pair<std::optional<RoofPlane>, std::vector<RoofCellAt>> grow(const RoofCellAt& seed,
                                                                    std::int32_t group) {
    const CellSums& own = all_.cells(seed.column, seed.row).high;
    const double seed_z = static_cast<double>(own.z / own.count) / 1000;
    PlaneSums start(all_.centre(seed.column, seed.row), seed_z);
    around(seed, reach_, [&](const RoofCellAt& near) {
      if (plane_(near.column, near.row) == kNone)
        start.add(all_.cells(near.column, near.row).high, all_.centre(near.column, near.row));
    });
    std::optional<RoofPlane> plane = start.fit();
    std::vector<RoofCellAt> grown;
    // The second pass begins with the plane of the first and drops what does not fit it.
    for (int pass = 0; pass < 2 && plane; ++pass) {
      for (const RoofCellAt& at : grown) plane_(at.column, at.row) = kNone;
      grown = {seed};
      plane_(seed.column, seed.row) = planes_;
      PlaneSums sums(all_.centre(seed.column, seed.row), seed_z);
      sums.add(own, all_.centre(seed.column, seed.row));
      double fitted = pass == 0 ? start.count() : std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < grown.size(); ++i) {
        around(grown[i], 1, [&](const RoofCellAt& near) {
          if (plane_(near.column, near.row) != kNone || group_(near.column, near.row) != group ||
              !joins(near, *plane))
            return;
          plane_(near.column, near.row) = planes_;
          grown.push_back(near);
          sums.add(all_.cells(near.column, near.row).high, all_.centre(near.column, near.row));
        });
        if (sums.count() < kRefit * fitted) continue;
        if (const auto better = sums.fit()) plane = better;
        fitted = sums.count();
      }
      if (const auto all = sums.fit())
        plane = all;
      else
        plane.reset();
    }
    return {plane, std::move(grown)};
  }

  bool joins(const RoofCellAt& at, const RoofPlane& plane) const {
    const RoofCell& cell = all_.cells(at.column, at.row);
    if (!(rms_distance(cell.high, all_.centre(at.column, at.row), plane) <= 2 * rules_.roughness))
      return false;
    const SmoothCell& smooth = smooth_(at.column, at.row);
    if (!smooth.is_smooth()) return true;
    const double cosine = (1 + smooth.slope_x * plane.slope_x + smooth.slope_y * plane.slope_y) *
                          plane.cosine() /
                          std::sqrt(1 + smooth.slope_x * smooth.slope_x + smooth.slope_y * smooth.slope_y);
    return cosine >= kMinCosine;
  }

  // Adjacent planes, and the cells between them, make a region.
  void join(const std::vector<RoofPlane>& planes, const std::vector<std::vector<RoofCellAt>>& cells,
            std::int32_t first, const std::vector<RoofCellAt>& members, RoofGroup& into) {
    if (planes.empty()) return;
    const auto belongs = [&](const RoofCellAt& at) { return plane_(at.column, at.row) >= first; };
    std::vector<RoofCellAt> enclosed;
    for (const RoofCellAt& at : members) {
      if (belongs(at)) continue;
      int beside = 0;
      around(at, 1, [&](const RoofCellAt& near) { beside += belongs(near); });
      if (beside >= kEnclosing) enclosed.push_back(at);
    }
    for (const RoofCellAt& at : enclosed) plane_(at.column, at.row) = planes_;  // no plane's number
    std::vector<RoofCellAt> ordered = members;
    std::ranges::sort(ordered, {}, [](const RoofCellAt& at) { return std::tuple(at.row, at.column); });
    Grid<std::uint8_t> done(into.box.columns, into.box.rows, 0);
    const auto is_done = [&](const RoofCellAt& at) -> std::uint8_t& {
      return done(at.column - into.box.column, at.row - into.box.row);
    };
    for (const RoofCellAt& start : ordered) {
      if (!belongs(start) || is_done(start)) continue;
      RoofRegion region;
      region.cells.push_back(start);
      is_done(start) = 1;
      for (std::size_t i = 0; i < region.cells.size(); ++i)
        around(region.cells[i], 1, [&](const RoofCellAt& near) {
          if (!into.box.contains(near.column, near.row) || !belongs(near) || is_done(near)) return;
          is_done(near) = 1;
          region.cells.push_back(near);
        });
      std::vector<std::uint8_t> used(planes.size(), 0);
      for (const RoofCellAt& at : region.cells)
        if (const auto p = static_cast<std::size_t>(plane_(at.column, at.row) - first); p < planes.size())
          used[p] = 1;
      for (std::size_t p = 0; p < planes.size(); ++p)
        if (used[p]) region.planes.push_back(planes[p]), region.plane_cells.push_back(cells[p]);
      std::ranges::sort(region.cells, {}, [](const RoofCellAt& at) { return std::tuple(at.row, at.column); });
      if (region.planes.empty()) continue;
      region.rough_cells = rough_near(region);
      into.regions.push_back(std::move(region));
    }
    // Numbers of enclosed cells must not be those of planes to come.
    ++planes_;
  }

  double rough_near(const RoofRegion& region) const {
    double rough = 0;
    for (const RoofCellAt& at : region.cells)
      around(at, 1, [&](const RoofCellAt& near) {
        rough += has_high(near.column, near.row) && plane_(near.column, near.row) == kNone ? 1.0 / 3 : 0;
      });
    return rough / static_cast<double>(region.cells.size());
  }

  const RoofCells& all_;
  const RoofRules& rules_;
  std::int64_t reach_;
  Grid<SmoothCell> smooth_;
  Grid<std::int32_t> group_, plane_;
  std::int32_t groups_ = 0, planes_ = 0;
};

}  // namespace

std::int64_t roof_margin(const RoofCells& cells) {
  return reach_of(cells) + dilation_of(cells) + 2;
}

std::vector<RoofGroup> find_roof_groups(const RoofCells& cells, const RoofRules& rules) {
  return Growing(cells, rules).run();
}

}  // namespace waymark::pipeline
