// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/column_flanks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace waymark::localization {
namespace {

constexpr double kColumns = 2.5;         // of the scanner, that belong to a flank
constexpr double kApart = 0.5;           // m between ranges of different things
constexpr double kMinNearer = 2;         // m that what hides half of a pole is nearer at least
constexpr double kWallDistance = 2;      // m from the scanner to the plane of a wall seen at a flat angle
constexpr double kClearlyFarther = 4;    // m: house fronts are set back by less
constexpr double kSameElevation = 0.12;  // m at the column
constexpr double kNothing = std::numeric_limits<double>::infinity();

// What the next columns on one side show: the least distance of what ends nearer, and of what ends farther.
struct Flank {
  double nearer = kNothing, farther = kNothing;  // m

  /// `wall_step`: m between the columns of a wall seen at a flat angle.
  bool cuts(const Flank& other, double wall_step) const {
    if (nearer == kNothing) return false;
    const bool is_half_hidden = nearer > std::max(kMinNearer, wall_step) && other.nearer == kNothing &&
                                other.farther > kClearlyFarther && other.farther < kNothing;
    return !is_half_hidden;
  }
};

}  // namespace

double cut_off_fraction(std::span<const ColumnLayer> layers, const CloudBearings& cloud, double bearing,
                        double range, double step) {
  if (layers.empty() || !(step > 0)) return 0;
  const double reach = kColumns * step, slack = kSameElevation / range;
  double widest = 0;
  for (const ColumnLayer& layer : layers) widest = std::max({widest, layer.left, -layer.right});
  std::vector<std::array<Flank, 2>> flanks(layers.size());
  cloud.within(bearing, widest + reach, [&](double off, double slope, double at) {
    if (std::abs(at - range) < kApart) return;
    for (std::size_t i = 0; i < layers.size(); ++i) {
      const ColumnLayer& layer = layers[i];
      if (slope < layer.low - slack || slope > layer.high + slack) continue;
      const double beside = std::max(off - layer.left, layer.right - off);
      if (beside < step / 2 || beside > reach) continue;
      Flank& flank = flanks[i][off > layer.left ? 0 : 1];
      if (at < range)
        flank.nearer = std::min(flank.nearer, range - at);
      else
        flank.farther = std::min(flank.farther, at - range);
    }
  });
  const double wall_step = range * range * step / kWallDistance;
  const auto cut = std::ranges::count_if(flanks, [&](const auto& sides) {
    return sides[0].cuts(sides[1], wall_step) || sides[1].cuts(sides[0], wall_step);
  });
  return static_cast<double>(cut) / static_cast<double>(layers.size());
}

}  // namespace waymark::localization
