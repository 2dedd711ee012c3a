// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/wall_lines.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "localization/detectors/scan_segments.hpp"

namespace waymark::localization {
namespace {

using Hits = std::vector<Eigen::Vector2d>;

WallLine fit_wall(const Hits& hits, const BeamSegment& run, double beam_sd) {
  WallLine line{.first = run.first, .last = run.last};
  const auto n = static_cast<double>(run.beams());
  for (std::size_t i = run.first; i <= run.last; ++i) line.centre += hits[i] / n;
  double xx = 0, xy = 0, yy = 0;
  for (std::size_t i = run.first; i <= run.last; ++i) {
    const Eigen::Vector2d d = hits[i] - line.centre;
    xx += d.x() * d.x(), xy += d.x() * d.y(), yy += d.y() * d.y();
  }
  // The axis of the larger moment of inertia of the scatter.
  const double axis = std::atan2(2 * xy, xx - yy) / 2;
  line.along = {std::cos(axis), std::sin(axis)};
  if (line.along.dot(hits[run.last] - hits[run.first]) < 0) line.along = -line.along;
  line.normal = {-line.along.y(), line.along.x()};
  if (line.normal.dot(line.centre) > 0) line.normal = -line.normal;
  line.begin = line.along.dot(hits[run.first] - line.centre);
  line.end = line.along.dot(hits[run.last] - line.centre);
  double across = 0, along = 0;
  for (std::size_t i = run.first; i <= run.last; ++i) {
    const Eigen::Vector2d d = hits[i] - line.centre;
    across += std::pow(line.normal.dot(d), 2);
    along += std::pow(line.along.dot(d), 2);
  }
  const double variance = std::max(beam_sd * beam_sd, n > 2 ? across / (n - 2) : 0);
  line.centre_variance = variance / n;
  line.angle_variance = along > 0 ? std::min(variance / along, 1.0) : 1;
  return line;
}

double max_deviation(const Hits& hits, const WallLine& line) {
  double deviation = 0;
  for (std::size_t i = line.first; i <= line.last; ++i)
    deviation = std::max(deviation, std::abs(line.normal.dot(hits[i] - line.centre)));
  return deviation;
}

// Merges neighbouring pieces of a run while one line fits both. The best fit goes first: the piece between
// two walls, at their corner, falls to the same one whichever way the scanner turns.
std::vector<WallLine> merge_neighbours(const Hits& hits, const std::vector<BeamSegment>& pieces,
                                       double beam_sd, double tolerance) {
  struct Joint {
    WallLine line;
    double deviation;
  };
  std::vector<WallLine> lines;
  std::vector<Joint> joints;  // of each line with the next
  const auto join = [&](std::size_t i) {
    const WallLine line = fit_wall(hits, {lines[i].first, lines[i + 1].last}, beam_sd);
    return Joint{line, max_deviation(hits, line)};
  };
  for (const BeamSegment& piece : pieces) lines.push_back(fit_wall(hits, piece, beam_sd));
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) joints.push_back(join(i));
  while (!joints.empty()) {
    const auto best = std::ranges::min_element(joints, {}, &Joint::deviation);
    if (!(best->deviation <= tolerance)) break;
    const auto i = static_cast<std::size_t>(best - joints.begin());
    lines[i] = best->line;
    lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    joints.erase(best);
    if (i > 0) joints[i - 1] = join(i - 1);
    if (i < joints.size()) joints[i] = join(i);
  }
  return lines;
}

// Splits at the hit farthest from the chord until all are within the tolerance. That hit, on a corner or
// beside it, belongs to no piece: on the wrong wall it would turn the line.
void split_at_farthest(const Hits& hits, const BeamSegment& run, double tolerance,
                       std::vector<BeamSegment>& pieces) {
  const Eigen::Vector2d chord = hits[run.last] - hits[run.first];
  const double length = chord.norm();
  double max_distance = 0;
  std::size_t farthest = run.first;
  for (std::size_t i = run.first + 1; i < run.last; ++i) {
    const Eigen::Vector2d d = hits[i] - hits[run.first];
    const double distance =
        length > 1e-9 ? std::abs(chord.x() * d.y() - chord.y() * d.x()) / length : d.norm();
    if (distance > max_distance) max_distance = distance, farthest = i;
  }
  if (!(max_distance > tolerance)) {
    pieces.push_back(run);
    return;
  }
  split_at_farthest(hits, {run.first, farthest - 1}, tolerance, pieces);
  split_at_farthest(hits, {farthest + 1, run.last}, tolerance, pieces);
}

/// Returns the line through the hits of two pieces, from their moments.
WallLine join_walls(const WallLine& a, const WallLine& b) {
  const auto beams = [](const WallLine& w) { return static_cast<double>(w.last - w.first + 1); };
  const double n = beams(a) + beams(b);
  WallLine joined{.first = std::min(a.first, b.first), .last = std::max(a.last, b.last)};
  joined.centre = (beams(a) * a.centre + beams(b) * b.centre) / n;
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  double variance = 0;
  for (const WallLine* const w : {&a, &b}) {
    const double of_hit = beams(*w) * w->centre_variance;  // m^2, of one hit across its line
    const Eigen::Vector2d off = w->centre - joined.centre;
    scatter +=
        beams(*w) * off * off.transpose() + of_hit / w->angle_variance * w->along * w->along.transpose();
    variance += beams(*w) / n * of_hit;
  }
  const double axis = std::atan2(2 * scatter(0, 1), scatter(0, 0) - scatter(1, 1)) / 2;
  joined.along = {std::cos(axis), std::sin(axis)};
  if (joined.along.dot(a.along) < 0) joined.along = -joined.along;
  joined.normal = {-joined.along.y(), joined.along.x()};
  if (joined.normal.dot(joined.centre) > 0) joined.normal = -joined.normal;
  joined.begin = std::numeric_limits<double>::infinity(), joined.end = -joined.begin;
  for (const WallLine* const w : {&a, &b})
    for (const double end : {w->begin, w->end}) {
      const double s = joined.along.dot(w->at(end) - joined.centre);
      joined.begin = std::min(joined.begin, s), joined.end = std::max(joined.end, s);
    }
  joined.centre_variance = variance / n;
  joined.angle_variance = variance / joined.along.dot(scatter * joined.along);
  return joined;
}

}  // namespace

std::vector<WallLine> join_collinear(std::vector<WallLine> walls, double max_turn, double max_offset) {
  const auto longest_first = [&] { std::ranges::stable_sort(walls, std::greater<>{}, &WallLine::length); };
  longest_first();
  for (std::size_t i = 0; i < walls.size(); ++i)
    for (std::size_t j = i + 1; j < walls.size();) {
      const WallLine &a = walls[i], &b = walls[j];
      const bool is_one = a.normal.dot(b.normal) > std::cos(max_turn) &&
                          std::abs(a.normal.dot(b.centre - a.centre)) < max_offset &&
                          std::abs(b.normal.dot(a.centre - b.centre)) < max_offset + max_turn * a.length();
      if (!is_one) {
        ++j;
        continue;
      }
      walls[i] = join_walls(a, b);
      walls.erase(walls.begin() + static_cast<std::ptrdiff_t>(j));
    }
  longest_first();
  return walls;
}

std::vector<WallLine> find_wall_lines(const LaserScan& scan, const WallLineOptions& options) {
  const std::vector<double> ranges = bridge_outliers(scan, options.jump);
  Hits hits(ranges.size());
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const double angle = scan.first_angle + static_cast<double>(i) * scan.angle_step;
    hits[i] = ranges[i] * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }
  std::vector<WallLine> walls;
  for (const BeamSegment& run : split_at_jumps(ranges, options.jump, options.jump_per_metre)) {
    if (!(ranges[run.first] < scan.max_range)) continue;  // no return
    std::vector<BeamSegment> pieces;
    split_at_farthest(hits, run, options.tolerance, pieces);
    for (const WallLine& line : merge_neighbours(hits, pieces, options.beam_sd, options.tolerance))
      if (line.length() >= options.min_length && line.last - line.first + 1 >= options.min_beams)
        walls.push_back(line);
  }
  return walls;
}

}  // namespace waymark::localization
