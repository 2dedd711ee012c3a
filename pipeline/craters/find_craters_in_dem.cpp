// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/find_craters.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "core/error.hpp"
#include "pipeline/craters/dem_rim.hpp"
#include "pipeline/craters/filled_image.hpp"
#include "pipeline/craters/shape_search.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kShallowest = 0.02;   // depth / diameter
constexpr double kMinKnown = 2.0 / 3;  // minimum fraction of heights in a crater's square
constexpr double kMinCorrelation = 0.45;
constexpr double kMaxOverlap = 0.15;  // intersection over union of two craters

void check(const DemCraterSearch& search) {
  const auto refuse = [](std::string problem, std::string hint) {
    throw Error(ErrorCode::usage, std::move(problem), "crater search in a DEM", std::move(hint));
  };
  if (!(search.cell_width > 0 && search.cell_height > 0))
    refuse(fmt::format("a cell is {} m x {} m", search.cell_width, search.cell_height),
           "both sides must be above 0");
  if (!(search.min_diameter >= 6))
    refuse(fmt::format("min_diameter is {} cells", search.min_diameter),
           "craters below 6 cells cannot be distinguished from noise");
  if (search.max_diameter != 0 && !(search.max_diameter >= search.min_diameter))
    refuse(fmt::format("max_diameter is {} cells, less than min_diameter, {} cells", search.max_diameter,
                       search.min_diameter),
           "0 means as large as the window allows");
}

// Heights of a dish with a rim.
std::vector<Pixels> dish(double diameter) {
  constexpr double reach = 1.5, rim = 0.25;
  const int half = static_cast<int>(std::ceil(diameter / 2 * reach)), side = 2 * half + 1;
  Pixels shape(side, side);
  double sum = 0, squares = 0;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const double r = std::hypot(x - half, y - half) / (diameter / 2);
      const double h = r < 1 ? (1 + rim) * r * r - 1 : rim / (r * r * r);
      shape(x, y) = static_cast<float>(h);
      sum += h;
    }
  const double mean = sum / (double(side) * side);
  for (float& h : shape.cells()) h = static_cast<float>(h - mean), squares += double(h) * h;
  for (float& h : shape.cells()) h = static_cast<float>(h / std::sqrt(squares));
  return {shape};
}

// Heights with NaN where unknown, resampled to square cells of the finer side.
Pixels square_cells(const HeightWindow& heights, double cell_width, double cell_height) {
  Pixels result(heights.columns(), heights.rows());
  for (std::int64_t i = 0; i < heights.columns() * heights.rows(); ++i) {
    const double h = heights.cells()[static_cast<std::size_t>(i)];
    result.cells()[static_cast<std::size_t>(i)] =
        std::isfinite(h) ? static_cast<float>(h) : std::numeric_limits<float>::quiet_NaN();
  }
  const double cell = std::sqrt(cell_width * cell_height);
  if (std::abs(cell_width / cell_height - 1) < 0.02) return result;
  const auto columns = std::max<std::int64_t>(1, std::llround(double(heights.columns()) * cell_width / cell));
  const auto rows = std::max<std::int64_t>(1, std::llround(double(heights.rows()) * cell_height / cell));
  Pixels square(columns, rows);
  const cv::Mat1f from(static_cast<int>(result.rows()), static_cast<int>(result.columns()),
                       result.cells().data());
  cv::Mat1f to(static_cast<int>(rows), static_cast<int>(columns), square.cells().data());
  cv::resize(from, to, to.size(), 0, 0, cv::INTER_LINEAR);
  return square;
}

// Logistic in correlation, lowest part of the rim, and size (relief on a large crater lowers its
// correlation). Weights were set by hand; offset and weight of size on the western half of a GLD100 piece
// (docs/methods/craters.md).
double probability(double correlation, const DemRim& rim, double cell) {
  const double cells = std::sqrt(rim.major * rim.minor),
               low_rim = std::clamp(rim.low_rim / (cells * cell), -0.02, 0.12);
  return 1 / (1 + std::exp(-(12 * (correlation - 0.72) + 30 * (low_rim - 0.03) + 0.3 * std::log2(cells / 16) -
                             0.77)));
}

}  // namespace

std::vector<DemCrater> find_craters(const HeightWindow& heights, const DemCraterSearch& search) {
  check(search);
  if (std::min(heights.columns(), heights.rows()) < 16) return {};
  const Pixels square = square_cells(heights, search.cell_width, search.cell_height);
  const FilledImage whole = fill_holes(square);
  if (whole.flat) return {};
  const double cell = std::sqrt(search.cell_width * search.cell_height);
  const double to_square =
      std::max(search.cell_width, search.cell_height) / cell;  // requested cells to cells of `square`
  const double side = double(std::min(square.columns(), square.rows()));
  const double smallest = search.min_diameter * to_square,
               largest = search.max_diameter > 0 ? search.max_diameter * to_square : 0.6 * side;
  auto candidates =
      suppress_overlaps(shape_candidates(whole.pixels, {.limits = {.min_diameter = 0.8 * smallest,
                                                                   .max_diameter = largest,
                                                                   .min_correlation = kMinCorrelation},
                                                        .shapes = dish,
                                                        .level_mean = 16}),
                        0.5);
  std::vector<CraterCandidate> circles;
  std::vector<DemRim> rims;
  for (const CraterCandidate& c : candidates) {
    if (whole.known_fraction(c.x, c.y, c.diameter) < kMinKnown) continue;
    const auto rim = measure_dem_rim(whole.pixels, c);
    if (!rim) continue;
    const double diameter = std::sqrt(rim->major * rim->minor);
    if (!(rim->depth > kShallowest * diameter * cell) || diameter < smallest || diameter > largest) continue;
    const double p = probability(c.score, *rim, cell);
    if (p < search.min_confidence) continue;
    circles.push_back({rim->x, rim->y, diameter, p});
    rims.push_back(*rim);
  }
  std::vector<DemCrater> result;
  for (const CraterCandidate& c : suppress_overlaps(circles, kMaxOverlap)) {
    const auto at = static_cast<std::size_t>(std::find(circles.begin(), circles.end(), c) - circles.begin());
    const DemRim& rim = rims[at];
    DemCrater crater;
    crater.column = (c.x + 0.5) * double(heights.columns()) / double(square.columns()) - 0.5;
    crater.row = (c.y + 0.5) * double(heights.rows()) / double(square.rows()) - 0.5;
    crater.major = rim.major * cell, crater.minor = rim.minor * cell, crater.angle = rim.angle;
    crater.centre_sd = cell * std::hypot(0.3, 0.04 * c.diameter);
    crater.diameter_sd = cell * std::hypot(0.4, 0.05 * c.diameter);
    crater.rim_height = rim.rim_height, crater.depth = rim.depth, crater.depth_sd = rim.depth_sd;
    crater.confidence = c.score;
    result.push_back(crater);
  }
  return result;
}

}  // namespace waymark::pipeline
