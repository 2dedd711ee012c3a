// SPDX-License-Identifier: Apache-2.0
#include "geo/terrain.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "geo/terrain_pyramid.hpp"

namespace waymark::inline geo {
namespace {

constexpr double kContactTolerance = 1e-6;  // metres below the terrain that count as on it
constexpr double kShadowLift = 1e-3;        // metres

}  // namespace

Terrain::Terrain(Grid<float> heights, double x0, double y0, double step_x, double step_y, double height_sd) {
  if (heights.columns() < 2 || heights.rows() < 2)
    throw Error(ErrorCode::input, "a terrain needs at least 2 x 2 heights",
                std::to_string(heights.columns()) + " x " + std::to_string(heights.rows()) + " given");
  if (!(step_x > 0) || !(step_y > 0) || !std::isfinite(step_x) || !std::isfinite(step_y))
    throw Error(ErrorCode::input, "the steps of a terrain must be above 0 m",
                "steps " + std::to_string(step_x) + " and " + std::to_string(step_y));
  pyramid_ = std::make_shared<const Pyramid>(std::move(heights), x0, y0, step_x, step_y, height_sd);
}

const Grid<float>& Terrain::heights() const {
  return pyramid_->heights;
}
double Terrain::x0() const {
  return pyramid_->x0;
}
double Terrain::y0() const {
  return pyramid_->y0;
}
double Terrain::step_x() const {
  return pyramid_->step_x;
}
double Terrain::step_y() const {
  return pyramid_->step_y;
}
double Terrain::height_sd() const {
  return pyramid_->height_sd;
}
double Terrain::min_height() const {
  return pyramid_->min_height;
}
double Terrain::max_height() const {
  return pyramid_->max_height;
}

std::optional<double> Terrain::height(double x, double y) const {
  const auto at = pyramid_->locate(x, y);
  if (!at) return std::nullopt;
  const Patch patch = pyramid_->patch(at->column, at->row);
  if (!patch.known()) return std::nullopt;
  return patch.height(at->u, at->v);
}

std::optional<Eigen::Vector3d> Terrain::normal(double x, double y) const {
  const auto at = pyramid_->locate(x, y);
  if (!at) return std::nullopt;
  const Patch patch = pyramid_->patch(at->column, at->row);
  if (!patch.known()) return std::nullopt;
  const double slope_x = (patch.b + patch.d * at->v) / pyramid_->step_x;
  const double slope_y = -(patch.c + patch.d * at->u) / pyramid_->step_y;
  return Eigen::Vector3d(-slope_x, -slope_y, 1).normalized();
}

RayHit Terrain::cast(const Ray<GridFrame>& ray, double max_range) const {
  const Pyramid& p = *pyramid_;
  const Eigen::Vector3d& origin = ray.origin.xyz;
  const Eigen::Vector3d& along = ray.direction.unit;
  const GridRay line = p.to_grid_ray(origin, along);
  auto range = p.clip_to_extent(line);
  if (!range || !(range->from <= max_range)) return {};
  range->to = std::min(range->to, max_range);
  const auto at = [&](RayEnd end, double t) { return RayHit{end, {origin + t * along}, t}; };

  const Eigen::Vector3d start = origin + range->from * along;
  const auto ground = height(std::clamp(start.x(), p.x0, p.x0 + p.step_x * double(p.heights.columns() - 1)),
                             std::clamp(start.y(), p.y0 - p.step_y * double(p.heights.rows() - 1), p.y0));
  if (ground && start.z() < *ground - kContactTolerance) return at(RayEnd::underground, range->from);

  const PyramidHit hit = p.first_hit(line, *range, UnknownCells::stop);
  if (hit.end == RayEnd::sky) return {};
  return at(hit.end, hit.t);
}

bool Terrain::in_shadow(const Point<GridFrame>& point, const Direction<GridFrame>& towards_light) const {
  const Eigen::Vector3d lifted = point.xyz + Eigen::Vector3d(0, 0, kShadowLift);
  const GridRay line = pyramid_->to_grid_ray(lifted, towards_light.unit);
  const auto range = pyramid_->clip_to_extent(line);
  return range && pyramid_->first_hit(line, *range, UnknownCells::pass).end == RayEnd::ground;
}

bool Terrain::reaches(const Point<GridFrame>& from, const Point<GridFrame>& to) const {
  const Eigen::Vector3d along = to.xyz - from.xyz;
  const double length = along.norm();
  if (!(length > 0)) {
    const auto ground = height(from.xyz.x(), from.xyz.y());
    return ground && *ground >= from.xyz.z();
  }
  const GridRay line = pyramid_->to_grid_ray(from.xyz, along / length);
  auto range = pyramid_->clip_to_extent(line);
  if (!range) return false;
  range->to = std::min(range->to, length);
  return range->from <= range->to &&
         pyramid_->first_hit(line, *range, UnknownCells::pass).end == RayEnd::ground;
}

}  // namespace waymark::inline geo
