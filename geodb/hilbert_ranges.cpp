// SPDX-License-Identifier: Apache-2.0
#include "geodb/hilbert_ranges.hpp"

#include <algorithm>

#include "geodb/rtree/hilbert.hpp"

namespace waymark::geodb {
namespace {

constexpr std::uint32_t kBins = 65536;
constexpr std::uint32_t kWidth = 65536;  // of a bin: all the curve is 2^32 long

std::uint16_t scaled(double value, double min, double max) {
  if (!(max > min)) return 0;
  return static_cast<std::uint16_t>((value - min) / (max - min) * 65535);
}

}  // namespace

std::uint32_t hilbert_position(const Eigen::Vector2d& position, const Envelope& extent) {
  return hilbert_index(scaled(position.x(), extent.min_x, extent.max_x),
                       scaled(position.y(), extent.min_y, extent.max_y));
}

std::vector<HilbertRange> divide_hilbert_curve(std::size_t parts, const PartPositions& positions,
                                               const Envelope& extent, std::size_t max_in_memory) {
  if (parts == 1) return {HilbertRange{.parts = {0}}};
  std::vector<std::uint32_t> count(kBins);
  std::vector<std::vector<std::uint16_t>> bins_of(parts);  // ascending
  for (std::size_t part = 0; part < parts; ++part) {
    std::vector<std::uint16_t>& part_bins = bins_of[part];
    positions(part, [&](const Eigen::Vector2d& position) {
      const auto bin = static_cast<std::uint16_t>(hilbert_position(position, extent) / kWidth);
      ++count[bin];
      if (part_bins.empty() || part_bins.back() != bin) part_bins.push_back(bin);
    });
    std::ranges::sort(part_bins);
    part_bins.erase(std::unique(part_bins.begin(), part_bins.end()), part_bins.end());
    part_bins.shrink_to_fit();
  }
  std::vector<HilbertRange> ranges;
  for (std::uint32_t begin = 0, end = 0; begin < kBins; begin = end) {
    std::size_t population = count[end++];
    while (end < kBins && population + count[end] <= max_in_memory) population += count[end++];
    if (population > 0)
      ranges.push_back({.first = begin * kWidth, .last = (end - 1) * kWidth + (kWidth - 1), .parts = {}});
  }
  for (std::uint32_t part = 0; part < parts; ++part)
    for (HilbertRange& range : ranges) {
      const auto bin = std::ranges::lower_bound(bins_of[part], range.first / kWidth);
      if (bin != bins_of[part].end() && *bin <= range.last / kWidth) range.parts.push_back(part);
    }
  return ranges;
}

}  // namespace waymark::geodb
