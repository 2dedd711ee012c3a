// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/rock_sun_angle.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "pipeline/rocks/bright_side.hpp"
#include "pipeline/rocks/find_shadow_rocks.hpp"
#include "pipeline/vision/middle_of.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr float kDark = 0.25F, kDeep = 0.6F;  // shadow fractions of clear spots and of nearly full shadow
// Resultant length of the doubled angles: 0.36 to 0.63 on bare ground, 0.02 to 0.28 on leaves, roofs and
// ripples; of the deep spots alone 0.51 to 0.85 and 0.05 to 0.45 (docs/methods/rocks.md).
constexpr double kMinAxis = 0.32, kMinDeepAxis = 0.5;
constexpr double kMinSpots = 8;
constexpr double kBeside = 0.8;  // radians about a direction
constexpr int kFewCraters = 10, kManyCraters = 40;
constexpr double kClear = 3, kVeryClear = 4;  // standard deviations of the difference of both sides
constexpr std::int64_t kSpotSide = 1000;      // of the middle of an image, pixels
constexpr double kBoulder = 20;               // pixels, diameter
constexpr double kClearBoulders = 3;          // by which one side has to lead

struct Spot {
  BrightSide side;
  float peak = 0;
};

std::vector<Spot> clear_spots(const Pixels& middle) {
  const auto map = map_shadows(middle, 32);
  std::vector<Spot> spots;
  if (!map) return spots;
  const SegmentLimits limits{.grow = std::max(0.04F, 1.25F * map->noise),
                             .seed = std::max(0.06F, 2.25F * map->noise),
                             .merge = 0.88F,
                             .max_cells = 4096};
  const std::int64_t columns = middle.columns();
  for (const ShadowSegment& segment : find_segments(*map, limits)) {
    const auto cells = static_cast<double>(segment.cells.size());
    if (cells < 3) continue;
    SpotDisc disc{.area = cells, .peak = static_cast<double>(segment.peak)};
    for (const std::int32_t cell : segment.cells) {
      disc.x += static_cast<double>(cell % columns) / cells;
      disc.y += static_cast<double>(cell / columns) / cells;
    }
    const Spot spot{bright_side(*map, disc), segment.peak};
    if (spot.side.weight > 0) spots.push_back(spot);
  }
  return spots;
}

/// Axis of the bright sides, by the mean of doubled angles.
struct Axis {
  double angle = 0, length = 0;
};

Axis axis_of(const std::vector<Spot>& spots, float min_peak) {
  double x = 0, y = 0, total = 0, count = 0;
  for (const Spot& spot : spots) {
    if (spot.peak < min_peak) continue;
    x += spot.side.weight * std::cos(2 * spot.side.angle);
    y += spot.side.weight * std::sin(2 * spot.side.angle);
    total += spot.side.weight;
    ++count;
  }
  if (count < kMinSpots) return {};
  return {std::atan2(y, x) / 2, std::hypot(x, y) / total};
}

/// Returns by how many standard deviations more light lies towards `angle` than on the opposite side.
double side_score(const std::vector<Spot>& spots, double angle, float min_peak) {
  double difference = 0, squares = 0, count = 0;
  for (const Spot& spot : spots) {
    if (spot.peak < min_peak) continue;
    const double off = std::abs(std::remainder(spot.side.angle - angle, kTurn));
    const double sign = off < kBeside ? 1 : off > kTurn / 2 - kBeside ? -1 : 0;
    difference += sign * spot.side.weight;
    squares += sign * sign * spot.side.weight * spot.side.weight;
    count += std::abs(sign);
  }
  return count >= kMinSpots && squares > 0 ? difference / std::sqrt(squares) : 0;
}

/// Returns the direction along the axis that `spots` show; 0 if they do not agree.
int side_of(const std::vector<Spot>& spots, double angle) {
  const double deep = side_score(spots, angle, kDeep), dark = side_score(spots, angle, kDark);
  if (std::abs(deep) < kClear && std::abs(dark) < kClear) return 0;
  if (std::abs(deep) >= kClear && std::abs(dark) >= kClear && deep * dark < 0) return 0;
  return std::abs(deep) >= kClear ? (deep > 0 ? 1 : -1) : (dark > 0 ? 1 : -1);
}

/// Returns the direction along the axis under which the largest dark spots are boulders; 0 if it is not
/// clear. A few boulders have too few spots for their bright sides to count, and resemble inverted craters.
int side_of_boulders(const Pixels& middle, double angle) {
  const double lead =
      count_boulders(middle, Radians{angle}) - count_boulders(middle, Radians{angle + kTurn / 2});
  return std::abs(lead) < kClearBoulders ? 0 : lead > 0 ? 1 : -1;
}

SunAngle refine(const std::vector<Spot>& spots, double angle) {
  double sum = 0, moment = 0, squares = 0;
  int count = 0;
  for (const Spot& spot : spots) {
    const double off = std::remainder(spot.side.angle - angle, kTurn);
    if (spot.peak < kDark || std::abs(off) > kBeside) continue;
    sum += spot.side.weight;
    moment += spot.side.weight * off;
    squares += spot.side.weight * spot.side.weight * off * off;
    ++count;
  }
  constexpr double kSystematic = 0.07;  // radians, found on 21 synthetic scenes
  if (!(sum > 0)) return {{angle}, {0.3}, 0};
  return {{std::remainder(angle + moment / sum, kTurn)},
          {std::hypot(std::sqrt(squares) / sum, kSystematic)},
          count};
}

}  // namespace

double count_rocks(const Pixels& image, Radians sun_angle, double min_diameter) {
  double sum = 0;
  for (const Detection& rock : find_shadow_rocks(image, {.min_diameter = min_diameter}, sun_angle).rocks)
    sum += rock.confidence;
  return sum;
}

double count_boulders(const Pixels& image, Radians sun_angle) {
  return count_rocks(image, sun_angle, kBoulder);
}

std::optional<SunAngle> estimate_rock_sun_angle(const Pixels& image, std::optional<SunAngle> craters) {
  const Pixels middle = middle_of(image, kSpotSide);
  const std::vector<Spot> spots = clear_spots(middle);
  Axis axis = axis_of(spots, 0);
  if (axis.length < kMinAxis) {
    axis = axis_of(spots, kDeep);
    if (axis.length < kMinDeepAxis) return std::nullopt;
  }
  if (craters) {
    constexpr double kAgree = 0.5;  // radians
    const double off = std::remainder(craters->angle.value - axis.angle, kTurn);
    const bool along = std::abs(std::remainder(off, kTurn / 2)) < kAgree;
    if (craters->shadows >= kFewCraters && along) {
      const double opposed = -side_score(spots, craters->angle.value, kDeep);
      if (opposed > kVeryClear && craters->shadows < kManyCraters) return std::nullopt;
      return craters;
    }
  }
  int side = side_of(spots, axis.angle);
  if (side == 0) side = side_of_boulders(middle, axis.angle);
  if (side == 0) return std::nullopt;
  return refine(spots, side > 0 ? axis.angle : axis.angle + kTurn / 2);
}

}  // namespace waymark::pipeline
