// SPDX-License-Identifier: Apache-2.0
#include "importers/points/inspect_canopy.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"

namespace waymark::importers {
namespace {

constexpr std::int64_t kSide = 128, kSquares = 6;   // cells; squares along each axis
constexpr float kMinHeight = -1, kMaxHeight = 150;  // metres

struct Sample {
  std::int64_t cells = 0, unknown = 0, below = 0, absurd = 0;
  float lowest = 0, highest = 0;

  std::int64_t known() const { return cells - unknown; }
};

void add(Sample& sample, const Grid<float>& heights) {
  for (const float h : heights.cells()) {
    ++sample.cells;
    if (h == kNoCanopy) {
      ++sample.unknown;
      continue;
    }
    sample.below += h < kMinHeight;
    sample.absurd += h > kMaxHeight;
    sample.lowest = std::min(sample.lowest, h);
    sample.highest = std::max(sample.highest, h);
  }
}

Sample sample_of(const CanopySource& canopy, const CanopyReader& read) {
  const GridGeometry& grid = canopy.geometry();
  const auto starts = [](std::int64_t length) {
    std::vector<std::int64_t> all;
    const std::int64_t last = std::max<std::int64_t>(0, length - kSide);
    for (std::int64_t i = 0; i < kSquares; ++i) all.push_back(last * i / (kSquares - 1));
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  };
  Sample sample;
  for (const std::int64_t row : starts(grid.rows))
    for (const std::int64_t column : starts(grid.columns))
      add(sample, read({column, row, std::min(kSide, grid.columns), std::min(kSide, grid.rows)}));
  return sample;
}

std::string percent(std::int64_t part, std::int64_t of) {
  return fmt::format("{:.3g} %", 100 * static_cast<double>(part) / static_cast<double>(of));
}

}  // namespace

std::vector<std::string> inspect_canopy(const CanopySource& canopy, const std::string& terrain,
                                        const std::string& file, const CanopyReader& read) {
  const Sample sample = sample_of(canopy, read);
  std::vector<std::string> warnings;
  if (sample.known() == 0) {
    warnings.push_back(file + ": no height is known in the sample: there may be no trees to find");
    return warnings;
  }
  if (sample.absurd > sample.known() / 2)
    throw Error(ErrorCode::input,
                fmt::format("most of it lies more than {:g} m above ground ({:.0f} m at most): these are "
                            "elevations, not heights of trees",
                            kMaxHeight, sample.highest),
                file,
                terrain.empty() ? "pass it as --dsm, with the terrain as --dtm"
                                : "check that the terrain belongs to it");
  if (!terrain.empty() && sample.below > sample.known() / 2)
    throw Error(
        ErrorCode::input,
        fmt::format("the terrain lies above the surface, by up to {:.1f} m, in most places", -sample.lowest),
        terrain, "are --dsm and --dtm exchanged?");
  if (sample.unknown > sample.cells / 20)
    warnings.push_back(fmt::format("{}: {} of the cells have no height: no trees are found there", file,
                                   percent(sample.unknown, sample.cells)));
  if (sample.below > 0)
    warnings.push_back(fmt::format("{}: {} of the heights are negative, down to {:.1f} m, and count as 0{}",
                                   file, percent(sample.below, sample.known()), sample.lowest,
                                   terrain.empty() ? "" : ": the terrain lies above the surface there"));
  if (sample.absurd > 0)
    warnings.push_back(
        fmt::format("{}: {} of the heights are above {:g} m, which no tree is, and are left out", file,
                    percent(sample.absurd, sample.known()), kMaxHeight));
  return warnings;
}

}  // namespace waymark::importers
