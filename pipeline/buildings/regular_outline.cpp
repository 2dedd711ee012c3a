// SPDX-License-Identifier: Apache-2.0
#include "pipeline/buildings/regular_outline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <optional>

namespace waymark::pipeline {
namespace {

constexpr std::size_t kMaxPoints = 1500;
constexpr double kMinStep = 0.6;        // m: of a wall that is resolved
constexpr double kChord = 3;            // m, for the dominant direction
constexpr double kPrice = 0.8;          // of a piece, times the square of the smallest step and 1 m
constexpr double kFreePrice = 3;        // of a piece of any direction, in prices
constexpr double kMinFree = 3;          // m: shortest piece of any direction
constexpr double kMinSine = 0.34;       // of the angle at a corner: 20 degrees
constexpr double kMinSd = 0.08;         // m
constexpr double kMaxAreaChange = 0.2;  // of the area
constexpr double kFar = std::numeric_limits<double>::infinity();

enum Axis : std::size_t { along_u, along_v, free_axis, kAxes };

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Returns positions along a ring, `step` apart, at the middles of the steps.
std::vector<Eigen::Vector2d> sample_ring(const RoofRing& ring, double step) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d from = ring[i], run = ring[(i + 1) % ring.size()] - from;
    const auto pieces = std::max<std::int64_t>(1, std::llround(run.norm() / step));
    for (std::int64_t k = 0; k < pieces; ++k)
      points.push_back(from + (static_cast<double>(k) + 0.5) / static_cast<double>(pieces) * run);
  }
  return points;
}

/// Returns the direction of most chords, modulo a right angle.
double chord_direction(const std::vector<Eigen::Vector2d>& points, double step) {
  const std::size_t n = points.size();
  const auto reach = std::clamp<std::size_t>(static_cast<std::size_t>(kChord / step), 1, n / 4 + 1);
  std::complex<double> sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d chord = points[(i + reach) % n] - points[i];
    if (!(chord.norm() > 0)) continue;
    sum += std::polar(chord.norm(), 4 * std::atan2(chord.y(), chord.x()));
  }
  const double angle = std::arg(sum) / 4;
  return angle < 0 ? angle + std::numbers::pi / 2 : angle;
}

struct Piece {
  std::size_t begin = 0, end = 0;  // points
  Axis axis = free_axis;
};

/// Sums of points in axes turned by the dominant direction; a piece is a range of them.
class Pieces {
 public:
  Pieces(const std::vector<Eigen::Vector2d>& points, double direction, double step, double min_step)
      : step_(step), min_step_(min_step), n_(points.size()), sums_(n_ + 1) {
    const double c = std::cos(direction), s = std::sin(direction);
    for (std::size_t i = 0; i < n_; ++i) {
      const double u = c * points[i].x() + s * points[i].y(), v = c * points[i].y() - s * points[i].x();
      const std::array<double, 5> add{u, v, u * u, u * v, v * v};
      for (std::size_t k = 0; k < add.size(); ++k) sums_[i + 1][k] = sums_[i][k] + add[k];
      turned_.emplace_back(u, v);
    }
  }

  /// Returns the pieces of least price; the first begins at point 0.
  std::vector<Piece> divide() const {
    const double price = kPrice * min_step_ * min_step_;
    const auto min_points = std::max<std::size_t>(2, static_cast<std::size_t>(std::floor(min_step_ / step_)));
    const auto min_free = std::max<std::size_t>(4, static_cast<std::size_t>(std::ceil(kMinFree / step_)));
    struct Best {
      double cost = kFar;
      std::size_t begin = 0;
      Axis before = kAxes;
    };
    std::vector<std::array<Best, kAxes>> best(n_ + 1);
    for (std::size_t end = min_points; end <= n_; ++end)
      for (std::size_t begin = 0; begin + min_points <= end; ++begin)
        for (const Axis axis : {along_u, along_v, free_axis}) {
          if (axis == free_axis && begin + min_free > end) continue;
          Best candidate{0, begin, kAxes};
          if (begin > 0) {
            candidate.cost = kFar;
            for (const Axis before : {along_u, along_v, free_axis})
              if ((before != axis || axis == free_axis) && best[begin][before].cost < candidate.cost)
                candidate.cost = best[begin][before].cost, candidate.before = before;
            if (candidate.cost == kFar) continue;
          }
          candidate.cost += cost(begin, end, axis) + (axis == free_axis ? kFreePrice : 1) * price;
          if (candidate.cost < best[end][axis].cost) best[end][axis] = candidate;
        }
    std::vector<Piece> pieces;
    std::size_t end = n_;
    Axis axis = along_u;
    for (const Axis other : {along_v, free_axis})
      if (best[n_][other].cost < best[n_][axis].cost) axis = other;
    if (best[n_][axis].cost == kFar) return {};
    while (end > 0) {
      const Best& of = best[end][axis];
      pieces.push_back({of.begin, end, axis});
      end = of.begin, axis = of.before;
    }
    std::ranges::reverse(pieces);
    return pieces;
  }

  /// Line in turned axes: a point on it, its direction, and the root mean square distance of its points.
  struct Line {
    Eigen::Vector2d at, along;
    double rms = 0, length = 0;
  };
  Line line(const Piece& piece, double ends) const {
    // Corners are rounded by the cells: points near the ends are left out of longer pieces.
    const auto skip = static_cast<std::size_t>(std::ceil(ends / step_));
    std::size_t begin = piece.begin, end = piece.end;
    if (end - begin > 4 * skip) begin += skip, end -= skip;
    const double n = static_cast<double>(end - begin);
    const auto [u, v, uu, uv, vv] = sums_of(begin, end);
    Line line{.at = {u / n, v / n}, .along = Eigen::Vector2d::UnitX()};
    const double cuu = uu / n - u * u / n / n, cvv = vv / n - v * v / n / n, cuv = uv / n - u * v / n / n;
    const Eigen::Vector2d run = turned_[piece.end - 1] - turned_[piece.begin];
    line.rms = std::sqrt(std::max(0.0, cvv));
    if (piece.axis == along_v)
      line.along = Eigen::Vector2d::UnitY(), line.rms = std::sqrt(std::max(0.0, cuu));
    if (piece.axis == free_axis) {
      const double angle = std::atan2(2 * cuv, cuu - cvv) / 2;
      line.along = {std::cos(angle), std::sin(angle)};
      line.rms = std::sqrt(std::max(0.0, (cuu + cvv) / 2 - std::hypot((cuu - cvv) / 2, cuv)));
    }
    if (line.along.dot(run) < 0) line.along = -line.along;
    line.length = std::abs(line.along.dot(run)) + step_;
    return line;
  }

  /// Returns the directions of the pieces' points modulo a right angle, weighted by the cubes of their
  /// lengths, as the variance of a direction is.
  double deviation(const std::vector<Piece>& pieces) const {
    std::complex<double> sum = 0;
    for (const Piece& piece : pieces) {
      if (piece.axis == free_axis) continue;
      const Line fitted = line({piece.begin, piece.end, free_axis}, min_step_);
      if (fitted.length < kChord) continue;
      sum += std::polar(std::pow(fitted.length, 3), 4 * std::atan2(fitted.along.y(), fitted.along.x()));
    }
    return std::abs(sum) > 0 ? std::arg(sum) / 4 : 0;
  }

  const Eigen::Vector2d& turned(std::size_t i) const { return turned_[i % n_]; }

 private:
  std::array<double, 5> sums_of(std::size_t begin, std::size_t end) const {
    std::array<double, 5> part;
    for (std::size_t k = 0; k < part.size(); ++k) part[k] = sums_[end][k] - sums_[begin][k];
    return part;
  }

  double cost(std::size_t begin, std::size_t end, Axis axis) const {
    const double n = static_cast<double>(end - begin);
    const auto [u, v, uu, uv, vv] = sums_of(begin, end);
    const double suu = std::max(0.0, uu - u * u / n), svv = std::max(0.0, vv - v * v / n);
    if (axis == along_u) return svv * step_;
    if (axis == along_v) return suu * step_;
    const double suv = uv - u * v / n;
    return std::max(0.0, (suu + svv) / 2 - std::hypot((suu - svv) / 2, suv)) * step_;
  }

  double step_, min_step_;
  std::size_t n_;
  std::vector<std::array<double, 5>> sums_;
  std::vector<Eigen::Vector2d> turned_;
};

RegularRing intersect_lines(const Pieces& pieces, const std::vector<Piece>& parts, double direction,
                            double spacing, double step) {
  std::vector<Pieces::Line> lines;
  for (const Piece& part : parts) lines.push_back(pieces.line(part, step));
  const auto sd = [&](const Pieces::Line& line) {
    // Labels of near cells depend on the same returns.
    const double independent = std::max(1.0, line.length / (4 * std::max(spacing, step)));
    return std::max(kMinSd, std::hypot(line.rms, 0.3 * spacing) / std::sqrt(independent));
  };
  RegularRing ring;
  const auto add = [&](const Eigen::Vector2d& at, double of_next) {
    const double c = std::cos(direction), s = std::sin(direction);
    ring.vertices.emplace_back(c * at.x() - s * at.y(), s * at.x() + c * at.y());
    ring.sd.push_back(of_next);
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::size_t before = (i + lines.size() - 1) % lines.size();
    const Pieces::Line &a = lines[before], &b = lines[i];
    const double sine = cross(a.along, b.along);
    const Eigen::Vector2d joint = (pieces.turned(parts[before].end - 1) + pieces.turned(parts[i].begin)) / 2;
    const Eigen::Vector2d meeting =
        std::abs(sine) > 1e-6 ? Eigen::Vector2d(a.at + cross(b.at - a.at, b.along) / sine * a.along) : joint;
    if (std::abs(sine) >= kMinSine || (std::abs(sine) > 1e-6 && (meeting - joint).norm() < kMinStep)) {
      add(meeting, sd(b));
      continue;
    }
    // Nearly parallel walls are joined by a short one.
    add(a.at + (joint - a.at).dot(a.along) * a.along, std::max(sd(a), sd(b)));
    add(b.at + (joint - b.at).dot(b.along) * b.along, sd(b));
  }
  return ring;
}

double distance_to(const std::vector<Eigen::Vector2d>& ring, const Eigen::Vector2d& p) {
  double distance = kFar;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d a = ring[i], run = ring[(i + 1) % ring.size()] - a;
    const double length2 = run.squaredNorm();
    const double t = length2 > 0 ? std::clamp((p - a).dot(run) / length2, 0.0, 1.0) : 0;
    distance = std::min(distance, (a + t * run - p).norm());
  }
  return distance;
}

bool follows(const RegularRing& ring, const std::vector<Eigen::Vector2d>& points, double area,
             double max_mean) {
  const double own = ring_area(ring.vertices);
  if (ring.vertices.size() < 3 || !(own * area > 0)) return false;
  if (!(std::abs(own - area) <= kMaxAreaChange * std::abs(area)) || !is_simple(ring.vertices)) return false;
  double sum = 0;
  for (const Eigen::Vector2d& p : points) sum += distance_to(ring.vertices, p);
  return sum <= max_mean * static_cast<double>(points.size());
}

/// Fits the walls of one ring; `std::nullopt` if they do not follow its edge.
std::optional<RegularRing> fit_ring(const RoofRing& ring, double cell, double spacing, double& direction,
                                    bool is_direction_known) {
  double perimeter = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) perimeter += (ring[(i + 1) % ring.size()] - ring[i]).norm();
  const double step = std::max(cell, perimeter / static_cast<double>(kMaxPoints));
  std::vector<Eigen::Vector2d> points = sample_ring(ring, step);
  const double min_step = std::max({kMinStep, 1.25 * spacing, 2 * step});
  if (!is_direction_known) direction = chord_direction(points, step);
  std::vector<Piece> parts;
  // First from anywhere, then from a joint with a better direction, then with the best.
  for (int pass = 0; pass < 3; ++pass) {
    const Pieces pieces(points, direction, step, min_step);
    parts = pieces.divide();
    if (parts.size() < 3) return {};
    if (!is_direction_known) direction += pieces.deviation(parts);
    if (pass == 2) break;
    std::rotate(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(parts[1].begin), points.end());
  }
  const Pieces pieces(points, direction, step, min_step);
  RegularRing fitted = intersect_lines(pieces, parts, direction, spacing, step);
  if (!follows(fitted, points, ring_area(ring), std::max(cell, 0.75 * spacing))) return {};
  return fitted;
}

RegularRing cell_ring(const RoofRing& ring, double cell, double spacing) {
  return {ring, std::vector<double>(ring.size(), std::max(cell, spacing) / 2)};
}

}  // namespace

bool is_simple(const std::vector<Eigen::Vector2d>& ring) {
  const std::size_t n = ring.size();
  const auto side = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
    return cross(b - a, p - a);
  };
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % n];
    if (!((b - a).norm() > 1e-9)) return false;
    for (std::size_t j = i + 1; j < n; ++j) {
      const Eigen::Vector2d &c = ring[j], &d = ring[(j + 1) % n];
      if (j == i + 1 || (i == 0 && j + 1 == n)) {  // neighbours: the next must not fold back
        const Eigen::Vector2d first = j == i + 1 ? Eigen::Vector2d(b - a) : Eigen::Vector2d(d - c),
                              second = j == i + 1 ? Eigen::Vector2d(d - c) : Eigen::Vector2d(b - a);
        if (!(std::abs(cross(first, second)) > 1e-12) && first.dot(second) < 0) return false;
        continue;
      }
      const bool apart = std::max(a.x(), b.x()) < std::min(c.x(), d.x()) ||
                         std::max(c.x(), d.x()) < std::min(a.x(), b.x()) ||
                         std::max(a.y(), b.y()) < std::min(c.y(), d.y()) ||
                         std::max(c.y(), d.y()) < std::min(a.y(), b.y());
      if (apart) continue;
      if (side(a, b, c) * side(a, b, d) <= 0 && side(c, d, a) * side(c, d, b) <= 0) return false;
    }
  }
  return true;
}

double ring_area(const std::vector<Eigen::Vector2d>& ring) {
  double twice = 0;
  for (std::size_t i = 0; i < ring.size(); ++i)
    twice += cross(ring[i] - ring[0], ring[(i + 1) % ring.size()] - ring[0]);
  return twice / 2;
}

RegularOutline regularise(const RoofOutline& roof) {
  RegularOutline outline;
  double direction = 0;
  if (auto outer = fit_ring(roof.outer, roof.cell, roof.spacing, direction, false)) {
    outline.outer = std::move(*outer);
  } else {
    outline.outer = cell_ring(roof.outer, roof.cell, roof.spacing);
    outline.kind = OutlineKind::cells;
  }
  outline.direction = std::fmod(direction + std::numbers::pi, std::numbers::pi / 2);
  for (const RoofRing& hole : roof.holes) {
    double same = direction;
    auto fitted = fit_ring(hole, roof.cell, roof.spacing, same, true);
    const auto is_inside = [&](const Eigen::Vector2d& p) {
      bool in = false;
      const auto& ring = outline.outer.vertices;
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
        if ((a.y() > p.y()) != (b.y() > p.y()) &&
            p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
          in = !in;
      }
      return in && distance_to(ring, p) > 0.1;
    };
    RegularRing ring = fitted ? std::move(*fitted) : cell_ring(hole, roof.cell, roof.spacing);
    // A courtyard that reaches the regular outline is left out.
    if (std::ranges::all_of(ring.vertices, is_inside)) outline.holes.push_back(std::move(ring));
  }
  return outline;
}

}  // namespace waymark::pipeline
