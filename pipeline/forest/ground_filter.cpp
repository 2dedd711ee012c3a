// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/ground_filter.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace waymark::pipeline {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Triangulation_vertex_base_with_info_2<double, Kernel>;
using Tin = CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Vertex>>;

using Square = std::pair<std::int64_t, std::int64_t>;  // row, column
using Lowest = std::map<Square, Eigen::Vector3d>;

Square square_of(const Eigen::Vector3d& p, double side) {
  return {static_cast<std::int64_t>(std::floor(p.y() / side)),
          static_cast<std::int64_t>(std::floor(p.x() / side))};
}

void keep_lowest(Lowest& lowest, const Eigen::Vector3d& p, double side) {
  const auto [at, fresh] = lowest.try_emplace(square_of(p, side), p);
  Eigen::Vector3d& best = at->second;
  if (!fresh && std::tie(p.z(), p.x(), p.y()) < std::tie(best.z(), best.x(), best.y())) best = p;
}

// Removes returns far below the ground: late echoes, wells.
std::vector<Eigen::Vector3d> sound_returns(const Lowest& cells, const GroundRules& rules) {
  constexpr double kNear = 4;  // metres
  Lowest squares;
  for (const auto& [at, p] : cells) keep_lowest(squares, p, kNear);
  std::vector<Eigen::Vector3d> sound;
  for (const auto& [at, p] : cells) {
    const auto [row, column] = square_of(p, kNear);
    double around = 1e300;
    for (std::int64_t r = row - 1; r <= row + 1; ++r)
      for (std::int64_t c = column - 1; c <= column + 1; ++c)
        if (const auto found = squares.find({r, c}); found != squares.end() && found->second != p)
          around = std::min(around, found->second.z());
    if (around > 1e299 || p.z() > around - rules.max_depth_below) sound.push_back(p);
  }
  return sound;
}

// Removes seeds in crowns of squares without ground returns: they are steeply above most neighbouring seeds.
// Partial squares at the edge of the survey often have one.
Lowest level_seeds(const Lowest& squares, const GroundRules& rules) {
  Lowest level;
  for (const auto& [at, p] : squares) {
    std::vector<double> slopes;
    for (std::int64_t r = at.first - 1; r <= at.first + 1; ++r)
      for (std::int64_t c = at.second - 1; c <= at.second + 1; ++c)
        if (const auto found = squares.find({r, c}); found != squares.end() && found->second != p) {
          const Eigen::Vector3d& q = found->second;
          slopes.push_back((p.z() - q.z()) / std::max((p - q).head<2>().norm(), 1.0));
        }
    const auto middle = slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() / 2);
    std::nth_element(slopes.begin(), middle, slopes.end());
    if (slopes.empty() || *middle < rules.max_seed_slope) level.emplace(at, p);
  }
  return level;
}

Eigen::Vector3d corner(const Tin::Vertex_handle& v) {
  return {v->point().x(), v->point().y(), v->info()};
}

// Returns whether a return is ground by its triangle.
bool joins(const Tin::Face_handle& face, const Eigen::Vector3d& p, const GroundRules& rules) {
  const Eigen::Vector3d a = corner(face->vertex(0)), b = corner(face->vertex(1)), c = corner(face->vertex(2));
  Eigen::Vector3d up = (b - a).cross(c - a);
  if (!(up.norm() > 1e-9)) return false;
  up.normalize();
  const double off = std::abs(up.dot(p - a));
  if (off > rules.distance) return false;
  for (const Eigen::Vector3d& v : {a, b, c}) {
    const double way = (p - v).norm();
    // Close to a corner, centimetres of noise cause any angle.
    if (off > 0.1 && off > way * std::sin(rules.angle)) return false;
  }
  return true;
}

// Extends the ground beyond the outermost seeds: distant corners at the height of the nearest seed.
void frame_in(Tin& tin, const std::vector<Eigen::Vector3d>& returns, double margin) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : returns) box.extend(p);
  for (const double x : {box.min().x() - margin, box.max().x() + margin})
    for (const double y : {box.min().y() - margin, box.max().y() + margin}) {
      const Kernel::Point_2 at(x, y);
      const double height = tin.nearest_vertex(at)->info();
      tin.insert(at)->info() = height;
    }
}

}  // namespace

std::vector<Eigen::Vector3d> ground_returns(std::span<const Eigen::Vector3d> returns,
                                            const GroundRules& rules) {
  Lowest cells, squares;
  for (const Eigen::Vector3d& p : returns)
    if (p.allFinite()) keep_lowest(cells, p, rules.cell);
  std::vector<Eigen::Vector3d> open = sound_returns(cells, rules);
  for (const Eigen::Vector3d& p : open) keep_lowest(squares, p, rules.square);
  squares = level_seeds(squares, rules);
  if (squares.size() < 4) return {};

  Tin tin;
  std::vector<Eigen::Vector3d> ground;
  for (const auto& [at, p] : squares) {
    tin.insert(Kernel::Point_2(p.x(), p.y()))->info() = p.z();
    ground.push_back(p);
  }
  if (tin.dimension() < 2) return {};
  frame_in(tin, open, rules.square);
  const auto known = [&](const Eigen::Vector3d& p) {
    const auto seed = squares.find(square_of(p, rules.square));
    return seed != squares.end() && seed->second == p;
  };
  std::erase_if(open, known);
  for (bool grows = true; grows;) {
    std::vector<Eigen::Vector3d> joining, left;
    Tin::Face_handle near;
    for (const Eigen::Vector3d& p : open) {
      near = tin.locate(Kernel::Point_2(p.x(), p.y()), near);
      const bool inside = near != nullptr && !tin.is_infinite(near);
      (inside && joins(near, p, rules) ? joining : left).push_back(p);
    }
    Tin::Face_handle at;
    for (const Eigen::Vector3d& p : joining) {
      const auto vertex = tin.insert(Kernel::Point_2(p.x(), p.y()), at);
      vertex->info() = p.z();
      at = vertex->face();
    }
    ground.insert(ground.end(), joining.begin(), joining.end());
    grows = !joining.empty();
    open = std::move(left);
  }
  return ground;
}

}  // namespace waymark::pipeline
