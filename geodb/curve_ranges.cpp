// SPDX-License-Identifier: Apache-2.0
#include "geodb/curve_ranges.hpp"

#include <algorithm>

#include "geodb/hilbert.hpp"

namespace waymark {
namespace {

constexpr std::uint32_t kBins = 65536;
constexpr std::uint32_t kWidth = 65536;  // of a bin: all the curve is 2^32 long

std::uint16_t scaled(double value, double lowest, double highest) {
  if (!(highest > lowest)) return 0;
  return static_cast<std::uint16_t>((value - lowest) / (highest - lowest) * 65535);
}

}  // namespace

std::uint32_t along_curve(const Eigen::Vector2d& place, const Envelope& extent) {
  return hilbert_index(scaled(place.x(), extent.min_x, extent.max_x),
                       scaled(place.y(), extent.min_y, extent.max_y));
}

std::vector<CurveRange> divide_curve(std::size_t parts, const PlacesOfPart& places, const Envelope& extent,
                                     std::size_t at_once) {
  if (parts == 1) return {CurveRange{.parts = {0}}};
  std::vector<std::uint32_t> count(kBins);
  std::vector<std::vector<std::uint16_t>> bins_of(parts);  // ascending
  for (std::size_t part = 0; part < parts; ++part) {
    std::vector<std::uint16_t>& own = bins_of[part];
    places(part, [&](const Eigen::Vector2d& place) {
      const auto bin = static_cast<std::uint16_t>(along_curve(place, extent) / kWidth);
      ++count[bin];
      if (own.empty() || own.back() != bin) own.push_back(bin);
    });
    std::ranges::sort(own);
    own.erase(std::ranges::unique(own).begin(), own.end());
    own.shrink_to_fit();
  }
  std::vector<CurveRange> ranges;
  for (std::uint32_t begin = 0, end = 0; begin < kBins; begin = end) {
    std::size_t held = count[end++];
    while (end < kBins && held + count[end] <= at_once) held += count[end++];
    if (held > 0)
      ranges.push_back({.first = begin * kWidth, .last = (end - 1) * kWidth + (kWidth - 1), .parts = {}});
  }
  for (std::uint32_t part = 0; part < parts; ++part)
    for (CurveRange& range : ranges) {
      const auto bin = std::ranges::lower_bound(bins_of[part], range.first / kWidth);
      if (bin != bins_of[part].end() && *bin <= range.last / kWidth) range.parts.push_back(part);
    }
  return ranges;
}

}  // namespace waymark
