// SPDX-License-Identifier: Apache-2.0
#include "importers/points/point_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/error.hpp"
#include "core/median.hpp"

namespace waymark::importers {
namespace {

constexpr double kMinDensity = 0.25;  // returns per m2; below, ground cannot be recognised by its shape
// Metres between the ground of the laser and a terrain model: more than the errors of both; surely another
// datum.
constexpr double kUsualOffset = 1, kMaxOffset = 10;

/// Returns the median height of ground points, or of the lowest point of each square of 5 m, above the
/// terrain model; NaN if there are too few.
double median_above_terrain(const PointsOnTerrain& survey) {
  constexpr int kSquares = 4;              // on each side
  constexpr double kSide = 40, kCell = 5;  // metres
  constexpr std::size_t kMinPoints = 20;
  const bool classified = survey.points.ground_points() > 0;
  const Georeference& where = survey.grid.where;
  std::vector<double> above;
  for (int i = 0; i < kSquares * kSquares; ++i) {
    const auto middle = [](int k, std::int64_t count) {
      return static_cast<std::int64_t>((k + 0.5) / kSquares * static_cast<double>(count));
    };
    const auto half = static_cast<std::int64_t>(kSide / 2 / (where.dx * survey.unit));
    const Window window{middle(i % kSquares, survey.grid.columns) - half,
                        middle(i / kSquares, survey.grid.rows) - half, 2 * half + 1, 2 * half + 1};
    const Grid<float> ground = survey.terrain.at(window);
    std::map<std::pair<std::int64_t, std::int64_t>, double> lowest;
    const auto first = [](std::int64_t k) { return static_cast<double>(k); };
    survey.points.visit(
        {where.x(first(window.column)), where.y(first(window.end_row())), where.x(first(window.end_column())),
         where.y(first(window.row))},
        [&](const LasPoint& p) {
          if (classified && p.classification != 2) return;
          const auto c = std::llround(where.column(p.x)) - window.column,
                     r = std::llround(where.row(p.y)) - window.row;
          if (!ground.contains(c, r) || std::isnan(ground(c, r))) return;
          const double height = p.z * survey.height_unit - static_cast<double>(ground(c, r));
          if (classified) {
            above.push_back(height);
            return;
          }
          const auto square = [](double v) { return static_cast<std::int64_t>(std::floor(v / kCell)); };
          const auto [at, is_new] =
              lowest.try_emplace({square(p.x * survey.unit), square(p.y * survey.unit)}, height);
          if (!is_new) at->second = std::min(at->second, height);
        });
    for (const auto& [square, height] : lowest) above.push_back(height);
  }
  if (above.size() < kMinPoints) return std::nan("");
  return median(std::move(above));
}

}  // namespace

Crs crs_of_points(const std::vector<LasHeader>& headers, const std::string& asked, const LasBox& box,
                  std::vector<std::string>& warnings) {
  if (!asked.empty()) return asked == "local" ? Crs::local() : Crs::from_text(asked);
  for (const LasHeader& header : headers)
    if (header.crs.has_value() != headers[0].crs.has_value() ||
        (header.crs && !header.crs->same_as(*headers[0].crs)))
      throw Error(
          ErrorCode::input,
          fmt::format("the files are in different coordinate reference systems: {} and {}",
                      headers[0].crs ? headers[0].crs->id() : "none", header.crs ? header.crs->id() : "none"),
          header.path, "pass --crs if one of them is wrong; else reproject them (las2las, pdal)");
  if (headers[0].crs) return *headers[0].crs;
  if (std::abs(box.left) <= 360 && std::abs(box.right) <= 360 && std::abs(box.low) <= 90 &&
      std::abs(box.high) <= 90 && box.right - box.left < 1 && box.high - box.low < 1)
    throw Error(ErrorCode::input, "the points seem to be in degrees, but trees are found in metres",
                headers[0].path,
                "reproject them (las2las -target_utm, pdal); or pass --crs local if they are metres");
  warnings.push_back(
      headers[0].path +
      ": it names no coordinate reference system that is known; its coordinates are taken as metres: "
      "pass --crs");
  return Crs::local();
}

void check_density(const LasCatalogue& points, double unit, const std::string& file,
                   std::vector<std::string>& warnings) {
  const LasBox& box = points.box();
  const double width = (box.right - box.left) * unit, height = (box.high - box.low) * unit;
  if (!(static_cast<double>(points.points()) > kMinDensity * width * height) ||
      !(std::min(width, height) > 20))
    throw Error(
        ErrorCode::input,
        "no point is classified as ground (class 2), and the points are too few to find it: heights of "
        "trees need the ground",
        file, "classify it first (pdal ground, lasground), or make rasters and pass --dsm and --dtm");
  warnings.push_back(
      file +
      ": no point is classified as ground (class 2): the ground is found by its shape (Axelsson "
      "2000), which confuses low dense canopy with steps of the terrain");
}

void compare_with_terrain(const PointsOnTerrain& survey, const std::string& file,
                          std::vector<std::string>& warnings) {
  const double offset = median_above_terrain(survey);
  if (std::isnan(offset)) return;
  const std::string what = fmt::format("the {} of the laser lie {:.1f} m {} the terrain model in the median",
                                       survey.points.ground_points() > 0 ? "ground points" : "lowest points",
                                       std::abs(offset), offset > 0 ? "above" : "below");
  const char* const hint =
      "is one of them above the ellipsoid and the other above the sea, or in feet? transform it (gdalwarp, "
      "pdal filters.reprojection with vertical CRSs)";
  if (std::abs(offset) > kMaxOffset) throw Error(ErrorCode::input, what, file, hint);
  if (std::abs(offset) > kUsualOffset && survey.points.ground_points() > 0)
    warnings.push_back(fmt::format("{}: {}: heights of trees are that much wrong; {}", file, what, hint));
}

}  // namespace waymark::importers
