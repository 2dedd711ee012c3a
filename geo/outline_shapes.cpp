// SPDX-License-Identifier: Apache-2.0
#include "geo/outline_shapes.hpp"

#include <algorithm>
#include <numbers>

#include "core/units.hpp"

namespace waymark::inline geo {
namespace {

using Kind = GeometryPart::Kind;
constexpr double kSamePoint = 1e-3;                   // m
constexpr double kMaxTurn = 170 * kRadiansPerDegree;  // beyond, a vertex is the tip of a spike
constexpr double kHalfTurn = std::numbers::pi;

double azimuth(const Eigen::Vector2d& v) {
  return std::atan2(v.x(), v.y());
}
Eigen::Vector2d right_of(const Eigen::Vector2d& v) {
  return {v.y(), -v.x()};
}
double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// A line or a ring without repeated vertices. Outlines run counter-clockwise and holes clockwise, so that
/// what they bound lies to the left.
struct Chain {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::size_t> number;  // of the vertices in the part
  std::vector<SharedVertex> shared;
  bool closed = false;
  bool line = false;  // seen from both sides, closed or not

  std::size_t pieces() const { return vertices.size() - (closed ? 0 : 1); }
  Eigen::Vector2d at(std::size_t i) const { return vertices[i % vertices.size()].head<2>(); }
  Eigen::Vector2d piece(std::size_t i) const { return at(i + 1) - at(i); }
};

double signed_area(const std::vector<Eigen::Vector3d>& ring) {
  double twice = 0;
  for (std::size_t i = 0; i < ring.size(); ++i)  // about the first vertex, for precision
    twice += cross((ring[i] - ring[0]).head<2>(), (ring[(i + 1) % ring.size()] - ring[0]).head<2>());
  return twice / 2;
}

bool same_point(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (a - b).head<2>().norm() < kSamePoint;
}

/// Returns whether a line ends where it begins, around an area.
bool is_closed_line(const GeometryPart& part) {
  return part.kind == Kind::line && part.vertices.size() > 3 &&
         same_point(part.vertices.front(), part.vertices.back());
}

Chain chain_of(const GeometryPart& part, const std::vector<SharedVertex>* shared, int& repeated) {
  const bool line = part.kind == Kind::line, ring = is_closed_line(part);
  Chain chain{.vertices = {}, .number = {}, .shared = {}, .closed = !line || ring, .line = line};
  for (std::size_t i = 0; i < part.vertices.size() - (ring ? 1 : 0); ++i) {
    if (!chain.vertices.empty() && same_point(chain.vertices.back(), part.vertices[i])) {
      ++repeated;
      if (shared && ((*shared)[i].joined || (*shared)[i].meeting)) chain.shared.back() = (*shared)[i];
      continue;
    }
    chain.vertices.push_back(part.vertices[i]);
    chain.number.push_back(i + 1);
    chain.shared.push_back(shared ? (*shared)[i] : SharedVertex{});
  }
  while (chain.closed && chain.vertices.size() > 1 &&
         same_point(chain.vertices.front(), chain.vertices.back())) {
    ++repeated;
    chain.vertices.pop_back();
    chain.number.pop_back();
    chain.shared.pop_back();
  }
  const bool runs_left = signed_area(chain.vertices) > 0;
  if (!line && runs_left != (part.kind == Kind::outline)) {
    std::ranges::reverse(chain.vertices);
    std::ranges::reverse(chain.number);
    std::ranges::reverse(chain.shared);
    // The wall after a vertex is the one before it now.
    for (std::size_t i = 0; i + 1 < chain.shared.size(); ++i)
      std::swap(chain.shared[i].wall, chain.shared[i + 1].wall);
  }
  return chain;
}

/// Sides of a chain that are seen: +1 right of its run (the outside of an outline), -1 left.
std::vector<int> seen_sides(const Chain& chain, OpenSide open) {
  if (chain.line || open == OpenSide::both) return {1, -1};
  return {open == OpenSide::outside ? 1 : -1};
}

std::string label(const Chain& chain, std::size_t vertex, int side, bool several_sides) {
  std::string name = std::to_string(chain.number[vertex % chain.number.size()]);
  if (several_sides) name += side > 0 ? "r" : "l";
  return name;
}

/// Adds the corners between three walls or more that meet at a vertex.
void add_wedges(const Chain& chain, std::size_t i, const ShapeOptions& options, DerivedShapes& into) {
  int number = 0;
  for (const auto& [right, left] : chain.shared[i].wedges) {
    const Eigen::Vector2d a = right - chain.at(i), b = left - chain.at(i);
    if (a.norm() < options.min_length || b.norm() < options.min_length) {
      ++into.omitted["wall of a corner shorter than min_length"];
      continue;
    }
    double opening = std::atan2(cross(a, b), a.dot(b));
    if (opening <= 0) opening += 2 * kHalfTurn;
    if (std::abs(opening - kHalfTurn) < options.min_turn) continue;  // a wall that goes on
    if (std::abs(opening - kHalfTurn) > kMaxTurn) {
      ++into.omitted["tip of a spike"];
      continue;
    }
    const double middle = std::atan2(a.y(), a.x()) + opening / 2;
    into.shapes.push_back({.at = chain.vertices[i],
                           .vertex = std::to_string(chain.number[i]) + "w" + std::to_string(++number),
                           .values = {{"direction", azimuth({std::cos(middle), std::sin(middle)})},
                                      {"opening_angle", opening}}});
  }
}

void add_corners(const Chain& chain, const ShapeOptions& options, DerivedShapes& into) {
  const std::size_t n = chain.vertices.size();
  const auto sides = seen_sides(chain, options.open);
  for (std::size_t i = 0; i < n; ++i) {
    if (chain.shared[i].meeting) {
      add_wedges(chain, i, options, into);
      continue;
    }
    const auto& next = chain.shared[i].next;
    const bool first = !chain.closed && i == 0, last = !chain.closed && i + 1 == n;
    if ((first || last) && !next) continue;
    const Eigen::Vector2d before =
        first ? Eigen::Vector2d(chain.at(i) - *next) : chain.piece((i + n - 1) % n);
    const Eigen::Vector2d after = last ? Eigen::Vector2d(*next - chain.at(i)) : chain.piece(i);
    if (before.norm() < options.min_length || after.norm() < options.min_length) {
      ++into.omitted["wall of a corner shorter than min_length"];
      continue;
    }
    const Eigen::Vector2d a = before.normalized(), b = after.normalized();
    const double turn = std::atan2(cross(a, b), a.dot(b));  // > 0 to the left
    if (std::abs(turn) < options.min_turn) continue;        // no corner
    if (std::abs(turn) > kMaxTurn) {
      ++into.omitted["tip of a spike"];
      continue;
    }
    if (chain.shared[i].corner) {
      ++into.omitted["corner shared with another outline"];
      continue;
    }
    for (const int side : sides) {
      const Eigen::Vector2d open = double(side) * right_of(a + b);
      into.shapes.push_back(
          {.at = chain.vertices[i],
           .vertex = label(chain, i, side, sides.size() > 1),
           .values = {{"direction", azimuth(open)}, {"opening_angle", kHalfTurn + double(side) * turn}}});
    }
  }
}

void add_ends(const Chain& chain, const ShapeOptions& options, DerivedShapes& into) {
  if (chain.closed) return;
  const std::size_t n = chain.vertices.size();
  for (const bool last : {false, true}) {
    const std::size_t i = last ? n - 1 : 0;
    const Eigen::Vector2d wall = last ? Eigen::Vector2d(-chain.piece(n - 2)) : chain.piece(0);
    if (chain.shared[i].joined) {
      ++into.omitted["end that touches another line"];
      continue;
    }
    if (wall.norm() < options.min_length) {
      ++into.omitted["wall of an end shorter than min_length"];
      continue;
    }
    for (const int side : {1, -1}) {
      const Eigen::Vector2d normal = double(side) * right_of(wall.normalized());
      // Who looks at the face looks against its normal and has the wall on the left or the right.
      const double left = -right_of(-normal).dot(wall.normalized());
      into.shapes.push_back({.at = chain.vertices[i],
                             .vertex = label(chain, i, side, true),
                             .values = {{"direction", azimuth(normal)}, {"side", left > 0 ? 1.0 : -1.0}}});
    }
  }
}

void add_walls(const Chain& chain, const ShapeOptions& options, DerivedShapes& into) {
  const auto sides = seen_sides(chain, options.open);
  for (std::size_t i = 0; i < chain.pieces(); ++i) {
    const Eigen::Vector2d run = chain.piece(i);
    if (run.norm() < options.min_length) {
      ++into.omitted["wall shorter than min_length"];
      continue;
    }
    if (chain.shared[i].wall) {
      ++into.omitted["wall shared with another outline"];
      continue;
    }
    const double pieces =
        options.max_length > 0 ? std::max(1.0, std::ceil(run.norm() / options.max_length - 1e-9)) : 1;
    const Eigen::Vector3d from = chain.vertices[i], to = chain.vertices[(i + 1) % chain.vertices.size()];
    for (double k = 0; k < pieces; ++k)
      for (const int side : sides) {
        std::string name = label(chain, i, side, sides.size() > 1);
        if (pieces > 1) name += "." + std::to_string(int(k) + 1);
        const double length = run.norm() / pieces;
        into.shapes.push_back(
            {.at = from + (k + 0.5) / pieces * (to - from),
             .vertex = name,
             .along_sd = length / std::sqrt(12.0),  // anywhere on the piece
             .along = run.normalized(),
             .values = {{"direction", azimuth(double(side) * right_of(run))}, {"length", length}}});
      }
  }
}

/// Area, centroid and second moments of rings, holes taken off; or of lines, or of points.
class Moments {
 public:
  void add_ring(const std::vector<Eigen::Vector3d>& ring, double sign) {
    const double around = signed_area(ring) < 0 ? -sign : sign;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d a = (ring[i] - zero(ring[i])).head<2>();
      const Eigen::Vector2d b = (ring[(i + 1) % ring.size()] - zero_).head<2>();
      const double twice = around * cross(a, b);
      weight_ += twice / 2;
      first_ += twice / 6 * (a + b);
      second_ += twice / 24 * (a * a.transpose() + b * b.transpose() + (a + b) * (a + b).transpose());
    }
    add_height(ring);
  }
  void add_line(const std::vector<Eigen::Vector3d>& line) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const Eigen::Vector2d a = (line[i] - zero(line[i])).head<2>(), b = (line[i + 1] - zero_).head<2>();
      const double length = (b - a).norm();
      weight_ += length;
      first_ += length / 2 * (a + b);
      second_ += length / 6 * (a * a.transpose() + b * b.transpose() + (a + b) * (a + b).transpose());
    }
    add_height(line);
  }
  void add_point(const Eigen::Vector3d& point) {
    const Eigen::Vector2d a = (point - zero(point)).head<2>();
    weight_ += 1;
    first_ += a;
    second_ += a * a.transpose();
    add_height({point});
  }

  double weight() const { return weight_; }
  Eigen::Vector3d centroid() const {
    const Eigen::Vector2d at = first_ / weight_;
    return {at.x() + zero_.x(), at.y() + zero_.y(), heights_ / std::max(1.0, count_)};
  }
  /// Azimuth of the long axis in (-pi/2, pi/2]; `std::nullopt` if no axis is longer.
  std::optional<double> orientation() const {
    const Eigen::Vector2d c = first_ / weight_;
    const Eigen::Matrix2d m = second_ / weight_ - c * c.transpose();
    const double east = m(0, 0) - m(1, 1), both = 2 * m(0, 1);
    if (std::hypot(east, both) < 1e-3 * m.trace()) return {};
    const double from_east = std::atan2(both, east) / 2;  // counter-clockwise
    return std::remainder(kHalfTurn / 2 - from_east, kHalfTurn);
  }

 private:
  const Eigen::Vector3d& zero(const Eigen::Vector3d& first) {
    if (!begun_) zero_ = {first.x(), first.y(), 0};
    begun_ = true;
    return zero_;
  }
  void add_height(const std::vector<Eigen::Vector3d>& vertices) {
    for (const Eigen::Vector3d& v : vertices) heights_ += v.z();
    count_ += double(vertices.size());
  }

  bool begun_ = false;
  Eigen::Vector3d zero_ = Eigen::Vector3d::Zero();
  double weight_ = 0, heights_ = 0, count_ = 0;
  Eigen::Vector2d first_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second_ = Eigen::Matrix2d::Zero();
};

void add_centroid(const std::vector<GeometryPart>& parts, DerivedShapes& into) {
  const auto has = [&](Kind kind) {
    return std::ranges::any_of(parts, [=](auto& p) { return p.kind == kind; });
  };
  const bool rings = has(Kind::outline) || std::ranges::any_of(parts, is_closed_line);
  const bool lines = has(Kind::line);
  Moments moments;
  for (const GeometryPart& part : parts) {
    if (rings && part.kind != Kind::point && (part.kind != Kind::line || is_closed_line(part)))
      moments.add_ring(part.vertices, part.kind == Kind::hole ? -1 : 1);
    else if (!rings && lines && part.kind == Kind::line)
      moments.add_line(part.vertices);
    else if (!rings && !lines)
      moments.add_point(part.vertices[0]);
  }
  if (!(moments.weight() > 0)) {
    ++into.omitted[rings ? "outline without area" : "line of zero length"];
    return;
  }
  DerivedShape shape{.at = moments.centroid(), .vertex = {}, .values = {}};
  if (rings) {
    shape.values["area"] = moments.weight();
    shape.values["diameter"] = std::sqrt(4 * moments.weight() / kHalfTurn);
  } else if (lines) {
    shape.values["length"] = moments.weight();
  }
  if (rings || lines)
    if (const auto axis = moments.orientation()) shape.values["orientation"] = *axis;
  into.shapes.push_back(std::move(shape));
}

}  // namespace

DerivedShapes derive_shapes(const std::vector<GeometryPart>& parts, const ShapeOptions& options,
                            const std::vector<std::vector<SharedVertex>>& shared) {
  DerivedShapes derived;
  if (parts.empty()) {
    ++derived.omitted["no geometry"];
    return derived;
  }
  const auto is_outline = [](const GeometryPart& part) {
    return part.kind == Kind::outline || is_closed_line(part);
  };
  if (options.shape == ShapeOf::outline && std::ranges::none_of(parts, is_outline)) {
    const bool line = std::ranges::any_of(parts, [](auto& part) { return part.kind == Kind::line; });
    ++derived.omitted[line ? "outline that is not closed" : "no outline"];
    return derived;
  }
  if (options.shape == ShapeOf::centroid || options.shape == ShapeOf::outline) {
    add_centroid(parts, derived);
    return derived;
  }
  bool fits = false;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const GeometryPart& part = parts[i];
    if (options.shape == ShapeOf::point) {
      if (part.kind != Kind::point) continue;
      fits = true;
      derived.shapes.push_back(
          {.at = part.vertices[0], .vertex = parts.size() > 1 ? std::to_string(i + 1) : "", .values = {}});
      continue;
    }
    if (part.kind == Kind::point || (options.shape == ShapeOf::ends && part.kind != Kind::line)) continue;
    fits = true;
    int repeated = 0;
    const Chain chain = chain_of(part, shared.empty() ? nullptr : &shared[i], repeated);
    if (repeated > 0 && options.shape == ShapeOf::walls) derived.omitted["wall of zero length"] += repeated;
    if (chain.vertices.size() < (chain.closed ? 3U : 2U)) {
      ++derived.omitted[chain.closed ? "outline without area" : "line of zero length"];
      continue;
    }
    if (options.shape == ShapeOf::corners) add_corners(chain, options, derived);
    if (options.shape == ShapeOf::ends) add_ends(chain, options, derived);
    if (options.shape == ShapeOf::walls) add_walls(chain, options, derived);
  }
  if (!fits)
    ++derived.omitted[options.shape == ShapeOf::point ? "no point" : "neither a line nor an outline"];
  return derived;
}

}  // namespace waymark::inline geo
