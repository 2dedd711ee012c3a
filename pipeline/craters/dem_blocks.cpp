// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/dem_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "geo/body.hpp"

namespace waymark::pipeline {
namespace {

struct CellSize {
  double width, height;  // metres
};

CellSize cell_size(const Georeference& where, double row) {
  if (where.crs.kind() != CrsKind::geographic) {
    const double unit = where.crs.metres_per_unit();
    return {std::abs(where.dx) * unit, std::abs(where.dy) * unit};
  }
  const double per_degree = where.crs.body().mean_radius() * std::numbers::pi / 180;
  const double latitude = where.y(row) * std::numbers::pi / 180;
  return {std::abs(where.dx) * per_degree * std::max(1e-3, std::cos(latitude)),
          std::abs(where.dy) * per_degree};
}

Observation to_observation(const DemCrater& crater, TypeId type, double column, double row,
                           const Georeference& where, const CellSize& cell) {
  Observation o;
  o.type = type;
  o.source = "DEM";
  o.pixel = Eigen::Vector2d(column, row);
  o.position.xyz << where.x(column), where.y(row), crater.rim_height;
  o.covariance = Eigen::Vector3d(crater.centre_sd * crater.centre_sd, crater.centre_sd * crater.centre_sd,
                                 std::max(1e-6, crater.depth_sd * crater.depth_sd))
                     .asDiagonal();
  o.confidence = crater.confidence;
  double azimuth = std::atan2(std::cos(crater.angle), -std::sin(crater.angle));  // clockwise from north
  azimuth = std::remainder(azimuth, std::numbers::pi);
  if (azimuth <= -std::numbers::pi / 2) azimuth += std::numbers::pi;
  const double sd = crater.diameter_sd, eccentric = std::max(cell.width, crater.major - crater.minor);
  const auto feature = [](double value, double deviation) {
    return FeatureValue{value, deviation * deviation, 1};
  };
  o.features = {feature(crater.diameter() / 2, sd / 2), feature(crater.depth, crater.depth_sd),
                feature(crater.major, sd), feature(crater.minor, sd),
                feature(azimuth, std::min(std::numbers::pi / 4, sd / eccentric))};
  return o;
}

}  // namespace

std::vector<Observation> survey_craters(const DemSource& dem, const Window& window, const DemSurvey& survey) {
  const GridGeometry& grid = dem.geometry();
  const Window all{0, 0, grid.columns, grid.rows};
  std::vector<Observation> found;
  const auto first = [](std::int64_t cell) { return cell / kDemCore * kDemCore; };
  for (std::int64_t row = first(std::max<std::int64_t>(0, window.row));
       row < std::min(window.end_row(), all.rows); row += kDemCore)
    for (std::int64_t column = first(std::max<std::int64_t>(0, window.column));
         column < std::min(window.end_column(), all.columns); column += kDemCore) {
      Window seen{column - kDemMargin, row - kDemMargin, kDemCore + 2 * kDemMargin,
                  kDemCore + 2 * kDemMargin};
      const auto right = grid.wraps ? seen.end_column() : std::min(seen.end_column(), grid.columns);
      const auto bottom = std::min(seen.end_row(), grid.rows);
      if (!grid.wraps) seen.column = std::max<std::int64_t>(0, seen.column);
      seen.row = std::max<std::int64_t>(0, seen.row);
      seen.columns = right - seen.column, seen.rows = bottom - seen.row;
      const CellSize cell = cell_size(grid.where, double(seen.row) + double(seen.rows) / 2);
      DemCraterSearch search = survey.search;
      search.cell_width = cell.width, search.cell_height = cell.height;
      search.max_diameter /= std::max(cell.width, cell.height) / std::sqrt(cell.width * cell.height);
      for (const DemCrater& crater : find_craters(dem.read(seen), search)) {
        const double at_column = crater.column + double(seen.column), at_row = crater.row + double(seen.row);
        const auto c = static_cast<std::int64_t>(std::lround(at_column)),
                   r = static_cast<std::int64_t>(std::lround(at_row));
        const Window core{column, row, kDemCore, kDemCore};
        if (!core.contains(c, r) || !window.contains(c, r) || !all.contains(c, r)) continue;
        found.push_back(to_observation(crater, survey.type, at_column, at_row, grid.where, cell));
      }
    }
  std::sort(found.begin(), found.end(), [](const Observation& a, const Observation& b) {
    return std::tuple(a.pixel->y(), a.pixel->x(), a.features[0].value) <
           std::tuple(b.pixel->y(), b.pixel->x(), b.features[0].value);
  });
  return found;
}

}  // namespace waymark::pipeline
