// SPDX-License-Identifier: Apache-2.0
#include "pipeline/buildings/find_buildings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/median.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kFlat = 8 * std::numbers::pi / 180;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kSample = 0.5;  // m along walls
// m2, of rasters: nothing but its facets distinguishes a smooth crown from a roof.
constexpr double kMinLargestPlane = 20, kMinMeanPlane = 12;

double cell_area(const RoofCells& cells) {
  return cells.width * cells.height;
}

/// Evidence of a region that it is a roof and no crown.
struct RoofEvidence {
  double penetration = kNan;  // fraction of pulses that split or pass
  double classed = 0;         // fraction of returns classified as building
  double plant = 0;           // fraction classified as vegetation
  double plane_area = 0;      // of the largest plane, m2
  double mean_plane_area = 0;
  double rms = 0;  // of the planes, by area
};

RoofEvidence weigh(const RoofCells& cells, const RoofRegion& region) {
  RoofEvidence evidence;
  // Pulses split on edges: the cells of the edge are left out.
  Grid<std::uint8_t> in(cells.window.columns, cells.window.rows, 0);
  for (const RoofCellAt& at : region.cells) in(at.column, at.row) = 1;
  double high = 0, low = 0, plant = 0, classed = 0, pulses = 0, split = 0;
  for (const RoofCellAt& at : region.cells) {
    int inside = 0;
    for (std::int64_t r = at.row - 1; r <= at.row + 1; ++r)
      for (std::int64_t c = at.column - 1; c <= at.column + 1; ++c) inside += in.contains(c, r) && in(c, r);
    if (inside < 9) continue;
    const RoofCell& cell = cells.cells(at.column, at.row);
    high += static_cast<double>(cell.high.count), low += cell.low, plant += cell.plant;
    classed += cell.classed, pulses += cell.pulses, split += cell.split;
  }
  const double all = high + low + plant;
  if (all > 0) evidence.plant = plant / all, evidence.classed = classed / all;
  if (pulses > 0 && all > 0) evidence.penetration = std::max(split / pulses, low / all);
  double area = 0;
  for (std::size_t p = 0; p < region.planes.size(); ++p) {
    const double own = static_cast<double>(region.plane_cells[p].size()) * cell_area(cells);
    evidence.plane_area = std::max(evidence.plane_area, own);
    evidence.rms += own * region.planes[p].rms, area += own;
  }
  evidence.rms /= area;
  evidence.mean_plane_area = area / static_cast<double>(region.planes.size());
  return evidence;
}

double confidence_of(const RoofEvidence& e, const RoofRegion& region, double returns,
                     const RoofRules& rules) {
  const auto saturate = [](double value, double scale) { return 1 - std::exp(-value / scale); };
  double doubt = 1;
  doubt *= saturate(returns, 15);         // few returns lie on a plane by chance
  doubt *= saturate(e.plane_area, 8);     // facets of crowns are small
  doubt *= 1 / (1 + region.rough_cells);  // trees are rough around their smooth cells
  doubt *= 1 - std::min(1.0, e.rms / rules.roughness) / 4;
  if (!std::isnan(e.penetration)) doubt *= 1 - e.penetration / rules.max_penetration / 2;
  return e.classed > 0.5 ? 1 - (1 - doubt) / 2 : doubt;
}

RoofKind kind_of(const RoofCells& cells, const RoofRegion& region, double& slope) {
  struct Face {
    double area, slope, azimuth;
  };
  std::vector<Face> faces;
  double all = 0, flat = 0;
  slope = 0;
  for (std::size_t p = 0; p < region.planes.size(); ++p) {
    const RoofPlane& plane = region.planes[p];
    const double area = static_cast<double>(region.plane_cells[p].size()) * cell_area(cells);
    const double tilt = std::atan(std::hypot(plane.slope_x, plane.slope_y));
    faces.push_back({area, tilt, std::atan2(-plane.slope_x, -plane.slope_y)});
    all += area, slope += area * tilt;
    if (tilt < kFlat) flat += area;
  }
  slope /= all;
  if (flat >= 0.8 * all) return RoofKind::flat;
  std::erase_if(faces, [&](const Face& f) { return f.slope < kFlat || f.area < 0.08 * all; });
  double sloping = 0;
  for (const Face& f : faces) sloping += f.area;
  if (faces.empty() || sloping < 0.8 * all) return RoofKind::complex;
  const auto apart = [](double a, double b) { return std::abs(std::remainder(a - b, 2 * std::numbers::pi)); };
  // Sides to which the faces slope, by quarters of the circle about the largest face.
  const Face& largest = *std::ranges::max_element(faces, {}, &Face::area);
  double side[4] = {}, between = 0;
  for (const Face& f : faces) {
    const double turn = std::remainder(f.azimuth - largest.azimuth, 2 * std::numbers::pi);
    const auto quarter = std::llround(turn / (std::numbers::pi / 2));
    if (apart(turn, static_cast<double>(quarter) * std::numbers::pi / 2) > std::numbers::pi / 8)
      between += f.area;
    else
      side[(quarter + 4) % 4] += f.area;
  }
  if (between > 0.2 * sloping) return RoofKind::complex;
  const auto sides = std::count_if(std::begin(side), std::end(side), [&](double a) { return a > 0; });
  if (sides == 1) return faces.size() == 1 ? RoofKind::shed : RoofKind::complex;
  if (sides == 2) return side[2] > 0 ? RoofKind::gabled : RoofKind::complex;
  return RoofKind::hipped;
}

/// Planes of a region by position.
class RoofSurface {
 public:
  RoofSurface(const RoofCells& cells, const RoofRegion& region) : cells_(cells), region_(region) {
    box_ = {region.cells[0].column, region.cells[0].row, 1, 1};
    std::int64_t right = box_.column, bottom = box_.row;
    for (const RoofCellAt& at : region.cells) {
      box_.column = std::min(box_.column, at.column), right = std::max(right, at.column);
      bottom = std::max(bottom, at.row);
    }
    box_.columns = right - box_.column + 1, box_.rows = bottom - box_.row + 1;
    plane_ = Grid<std::int32_t>(box_.columns, box_.rows, -1);
    for (std::size_t p = 0; p < region.planes.size(); ++p)
      for (const RoofCellAt& at : region.plane_cells[p])
        plane_(at.column - box_.column, at.row - box_.row) = static_cast<std::int32_t>(p);
  }

  /// Returns the roof's height at a position by the nearest plane within two cells; NaN if there is none.
  double z(double x, double y) const {
    const auto [c, r] = cells_.cell_of(x, y);
    double nearest = std::numeric_limits<double>::infinity(), z = kNan;
    for (std::int64_t j = r - 2; j <= r + 2; ++j)
      for (std::int64_t i = c - 2; i <= c + 2; ++i) {
        const std::int64_t k = i - box_.column, l = j - box_.row;
        if (!plane_.contains(k, l) || plane_(k, l) < 0) continue;
        const double away = (cells_.centre(i, j) - Eigen::Vector2d(x, y)).squaredNorm();
        if (away < nearest)
          nearest = away, z = region_.planes[static_cast<std::size_t>(plane_(k, l))].z(x, y);
      }
    return z;
  }

 private:
  const RoofCells& cells_;
  const RoofRegion& region_;
  Window box_;
  Grid<std::int32_t> plane_;
};

/// Ground under a building, by position; 0 where heights have no elevation.
class GroundBelow {
 public:
  GroundBelow(const CanopySource& canopy, const RoofCells& cells, const Window& window)
      : cells_(cells), window_(window), ground_(canopy.ground(window)) {}

  double at(double x, double y) const {
    const auto c = std::llround(x / cells_.cell_x) - window_.column,
               r = std::llround(-y / cells_.cell_y) - window_.row;
    return ground_.contains(c, r) ? static_cast<double>(ground_(c, r)) : kNan;
  }

 private:
  const RoofCells& cells_;
  Window window_;
  Grid<float> ground_;
};

template <class Visit>
void along(const Eigen::Vector2d& from, const Eigen::Vector2d& to, Visit&& visit) {
  const auto pieces = std::max<std::int64_t>(1, std::llround((to - from).norm() / kSample));
  for (std::int64_t k = 0; k < pieces; ++k)
    visit(Eigen::Vector2d(from + (static_cast<double>(k) + 0.5) / static_cast<double>(pieces) * (to - from)));
}

void measure_heights(DetectedBuilding& building, const RoofOutline& outline, const RoofSurface& surface,
                     const GroundBelow& below) {
  const auto& ring = building.outline.outer.vertices;
  std::vector<double> ground;
  for (std::size_t i = 0; i < ring.size(); ++i)
    along(ring[i], ring[(i + 1) % ring.size()], [&](const Eigen::Vector2d& at) {
      if (const double g = below.at(at.x(), at.y()); !std::isnan(g)) ground.push_back(g);
    });
  building.ground = ground.empty() ? kNan : median(ground);
  const double zero = ground.empty() ? 0 : building.ground;
  double top = -std::numeric_limits<double>::infinity();
  // Beyond a ridge the nearest plane rises on: the roof is no higher than its return. Chimneys are on no
  // plane.
  for (const SurfacePoint& p : outline.roof)
    if (const double z = std::min(surface.z(p.x, p.y), p.z); z - zero > top) top = z - zero;
  building.height = top;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    std::vector<double> heights;
    along(ring[i], ring[(i + 1) % ring.size()], [&](const Eigen::Vector2d& at) {
      const double g = below.at(at.x(), at.y());
      if (const double z = surface.z(at.x(), at.y()); !std::isnan(z))
        heights.push_back(z - (std::isnan(g) ? zero : g));
    });
    building.wall_heights.push_back(heights.empty() ? kNan : median(std::move(heights)));
  }
}

class Search {
 public:
  Search(const CanopySource& canopy, const Window& owned, const RoofRules& rules)
      : canopy_(canopy), owned_(owned), rules_(rules) {}

  FoundBuildings run() {
    const GridGeometry& grid = canopy_.geometry();
    const std::int64_t step = roof_cell_step(grid);
    const std::int64_t halo = building_halo(canopy_, rules_) / step;
    // Beyond the survey lie the margin's cells without returns.
    const std::int64_t beyond = 2 * roof_margin({.step = step,
                                                 .width = grid.where.dx * unit() * static_cast<double>(step),
                                                 .height = grid.where.dx * unit() * static_cast<double>(step),
                                                 .density = canopy_.point_density()});
    const auto floor = [&](std::int64_t k) { return k >= 0 ? k / step : -((step - 1 - k) / step); };
    Window window;
    window.column = std::max(floor(owned_.column) - halo, -beyond);
    window.row = std::max(floor(owned_.row) - halo, -beyond);
    window.columns =
        std::min(floor(owned_.end_column() - 1) + halo, floor(grid.columns - 1) + beyond) - window.column + 1;
    window.rows =
        std::min(floor(owned_.end_row() - 1) + halo, floor(grid.rows - 1) + beyond) - window.row + 1;
    if (owned_.cells() <= 0) return {};
    const RoofCells cells = sum_roof_cells(canopy_, window, rules_.min_height);
    for (const RoofGroup& group : find_roof_groups(cells, rules_)) add(cells, group);
    return std::move(found_);
  }

 private:
  double unit() const { return canopy_.geometry().where.crs.metres_per_unit(); }

  bool intersects_owned(const Window& box) const {
    return box.column < owned_.end_column() && owned_.column < box.end_column() &&
           box.row < owned_.end_row() && owned_.row < box.end_row();
  }
  static Window survey_cells(const RoofCells& cells, const Window& box) {
    return {(cells.window.column + box.column) * cells.step, (cells.window.row + box.row) * cells.step,
            box.columns * cells.step, box.rows * cells.step};
  }
  void reject(const char* reason, const RoofCells& cells, const RoofCellAt& first) {
    const std::int64_t column = (cells.window.column + first.column) * cells.step,
                       row = (cells.window.row + first.row) * cells.step;
    if (owned_.contains(std::max<std::int64_t>(0, column), std::max<std::int64_t>(0, row)))
      ++found_.rejected[reason];
  }

  void add(const RoofCells& cells, const RoofGroup& group) {
    const double across = std::max(static_cast<double>(group.box.columns) * cells.width,
                                   static_cast<double>(group.box.rows) * cells.height);
    if (across > rules_.max_extent)
      return reject("wider than max_extent", cells, {group.box.column, group.box.row});
    if (group.cut || !intersects_owned(survey_cells(cells, group.box))) return;
    for (const RoofRegion& region : group.regions) add(cells, region);
  }

  void add(const RoofCells& cells, const RoofRegion& region) {
    const RoofCellAt first = region.cells[0];
    if (static_cast<double>(region.cells.size()) * cell_area(cells) < rules_.min_area / 2)
      return reject("smaller than min_area", cells, first);
    const RoofEvidence evidence = weigh(cells, region);
    if (evidence.plant > 0.5) return reject("classified as vegetation", cells, first);
    if (evidence.penetration > rules_.max_penetration)
      return reject("pulses pass it: vegetation", cells, first);
    if (!(cells.density > 0) &&
        (evidence.plane_area < kMinLargestPlane || evidence.mean_plane_area < kMinMeanPlane))
      return reject("small planes in a raster: vegetation", cells, first);
    std::vector<SurfacePoint> returns;
    const Window around = roof_surroundings(cells, region);
    canopy_.visit_surface(around, [&](const SurfacePoint& p) {
      if (p.is_last()) returns.push_back(p);
    });
    const std::vector<RoofOutline> outlines = outline_roof(cells, region, std::move(returns), rules_);
    if (outlines.empty()) return reject("smaller than min_area", cells, first);
    const RoofSurface surface(cells, region);
    const GroundBelow below(canopy_, cells, around);
    for (const RoofOutline& outline : outlines) {
      if (outline.area < rules_.min_area) {
        reject("smaller than min_area", cells, first);
        continue;
      }
      DetectedBuilding building;
      building.confidence = confidence_of(evidence, region, static_cast<double>(outline.returns), rules_);
      if (!(building.confidence >= rules_.min_confidence)) {
        reject("min_confidence: few or rough planes", cells, first);
        continue;
      }
      building.outline = regularise(outline);
      if (is_cut(building)) {
        reject("cut by the edge of the survey", cells, first);
        continue;
      }
      building.area = ring_area(building.outline.outer.vertices);
      for (const RegularRing& hole : building.outline.holes) building.area += ring_area(hole.vertices);
      building.penetration = evidence.penetration;
      building.density = static_cast<double>(outline.returns) / outline.area;
      measure_heights(building, outline, surface, below);
      if (!(building.height >= rules_.min_height)) {
        reject("lower than min_height", cells, first);
        continue;
      }
      building.height_sd = std::hypot(0.1, evidence.rms);
      building.roof = kind_of(cells, region, building.slope);
      building.first_column = std::max<std::int64_t>(0, (cells.window.column + first.column) * cells.step);
      building.first_row = std::max<std::int64_t>(0, (cells.window.row + first.row) * cells.step);
      building.box = box_of(building, cells);
      if (intersects_owned(building.box) || owned_.contains(building.first_column, building.first_row))
        found_.buildings.push_back(std::move(building));
    }
  }

  Window box_of(const DetectedBuilding& building, const RoofCells& cells) const {
    double left = std::numeric_limits<double>::infinity(), right = -left, low = left, high = -left;
    for (const Eigen::Vector2d& v : building.outline.outer.vertices)
      left = std::min(left, v.x()), right = std::max(right, v.x()), low = std::min(low, v.y()),
      high = std::max(high, v.y());
    const std::int64_t column = std::llround(left / cells.cell_x), row = std::llround(-high / cells.cell_y);
    return {column, row, std::llround(right / cells.cell_x) - column + 1,
            std::llround(-low / cells.cell_y) - row + 1};
  }

  /// Returns whether a wall lies along the edge of the survey.
  bool is_cut(const DetectedBuilding& building) const {
    const GridGeometry& grid = canopy_.geometry();
    const double cell_x = grid.where.dx * unit(), cell_y = -grid.where.dy * unit();
    const double right = (static_cast<double>(grid.columns) - 1.0) * cell_x,
                 low = -(static_cast<double>(grid.rows) - 1.0) * cell_y;
    return std::ranges::any_of(building.outline.outer.vertices, [&](const Eigen::Vector2d& v) {
      return v.x() < cell_x / 2 || v.y() > -cell_y / 2 || v.x() > right - cell_x / 2 ||
             v.y() < low + cell_y / 2;
    });
  }

  const CanopySource& canopy_;
  Window owned_;
  const RoofRules& rules_;
  FoundBuildings found_;
};

}  // namespace

std::string to_string(RoofKind kind) {
  switch (kind) {
    case RoofKind::flat:
      return "flat";
    case RoofKind::shed:
      return "shed";
    case RoofKind::gabled:
      return "gabled";
    case RoofKind::hipped:
      return "hipped";
    case RoofKind::complex:
      break;
  }
  return "complex";
}

std::int64_t building_halo(const CanopySource& canopy, const RoofRules& rules) {
  const GridGeometry& grid = canopy.geometry();
  const std::int64_t step = roof_cell_step(grid);
  const double side = grid.where.dx * grid.where.crs.metres_per_unit() * static_cast<double>(step);
  const RoofCells one{.step = step, .width = side, .height = side, .density = canopy.point_density()};
  return (static_cast<std::int64_t>(std::ceil(rules.max_extent / side)) + 2 * roof_margin(one) + 1) * step;
}

FoundBuildings find_buildings(const CanopySource& canopy, const Window& owned, const RoofRules& rules) {
  return Search(canopy, owned, rules).run();
}

bool is_on(const DetectedBuilding& building, const Eigen::Vector2d& at, double margin) {
  bool inside = false;
  double nearest = std::numeric_limits<double>::infinity();
  const auto visit = [&](const std::vector<Eigen::Vector2d>& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()], run = b - a;
      if ((a.y() > at.y()) != (b.y() > at.y()) &&
          at.x() < a.x() + (at.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
        inside = !inside;
      const double t = std::clamp((at - a).dot(run) / run.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (a + t * run - at).norm());
    }
  };
  visit(building.outline.outer.vertices);
  for (const RegularRing& hole : building.outline.holes) visit(hole.vertices);
  return inside || nearest <= margin;
}

}  // namespace waymark::pipeline
