// SPDX-License-Identifier: Apache-2.0
#include "workflows/planning/hazard_extras.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/error.hpp"
#include "workflows/parse_number.hpp"

namespace waymark::workflows {
namespace {

constexpr std::int64_t kMaxMargin = 4000;  // cells

std::vector<double> numbers_of(const std::string& name, const std::string& text) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    numbers.push_back(parse_number(name, text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return numbers;
}

[[noreturn]] void refuse(const std::string& problem, const std::string& hint) {
  throw Error(ErrorCode::usage, problem, "", hint);
}

void check_margin(std::int64_t cells, const std::string& what, const std::string& hint) {
  if (cells > kMaxMargin)
    refuse(fmt::format("{} reaches over {} cells, more than {}", what, cells, kMaxMargin), hint);
}

Grid<float> cropped(const Grid<float>& wide, const Window& inner) {
  Grid<float> out(inner.columns, inner.rows);
  for (std::int64_t r = 0; r < inner.rows; ++r)
    for (std::int64_t c = 0; c < inner.columns; ++c) out(c, r) = wide(inner.column + c, inner.row + r);
  return out;
}

}  // namespace

std::vector<planning::BandName> HazardExtras::bands() const {
  std::vector<planning::BandName> all;
  if (landing) all.push_back({"landing", ""});
  if (ray) all.insert(all.end(), {{"horizon", "deg"}, {"shade", ""}});
  return all;
}

HazardExtras parse_hazard_extras(const HazardMapRequest& request, const GridGeometry& grid) {
  HazardExtras extras;
  const double metres = grid.where.crs.metres_per_unit();
  const double cell_x = grid.where.dx * metres, cell_y = std::abs(grid.where.dy) * metres;
  if (!request.landing_ellipse.empty()) {
    const auto n = numbers_of("--landing-ellipse", request.landing_ellipse);
    if (n.size() < 2 || n.size() > 3 || !(n[1] > 0) || !(n[0] >= n[1]))
      refuse(fmt::format("--landing-ellipse {} is no ellipse", request.landing_ellipse),
             "MAJOR,MINOR[,AZIMUTH]: standard deviations in metres, the larger first; degrees from north");
    extras.landing = planning::covariance_in_cells({n[0], n[1], n.size() == 3 ? n[2] : 0}, cell_x, cell_y);
    const planning::LandingMargin margin = planning::landing_margin(*extras.landing);
    check_margin(std::max(margin.columns, margin.rows), "--landing-ellipse", "use a coarser DEM");
  }
  if (!request.sun.empty()) {
    const auto n = numbers_of("--sun", request.sun);
    if (n.size() != 2 || !(std::abs(n[0]) <= 360) || !(n[1] > -90 && n[1] <= 90))
      refuse(fmt::format("--sun {} is no direction", request.sun),
             "AZIMUTH,ELEVATION in degrees: clockwise from north, above the horizontal");
    if (!(request.horizon_reach > 0))
      refuse(fmt::format("--horizon-reach {:g} is not above 0 m", request.horizon_reach), "");
    extras.sun_elevation = n[1];
    const Body& body = grid.where.crs.body();
    extras.ray = planning::HorizonRay{.azimuth = n[0],
                                      .reach = request.horizon_reach,
                                      .cell_x = cell_x,
                                      .cell_y = cell_y,
                                      .body_radius = body.name.empty() ? 0 : body.mean_radius()};
    const planning::HorizonMargin m = planning::horizon_margin(*extras.ray);
    check_margin(std::max({m.west, m.east, m.north, m.south}), "--horizon-reach",
                 "shorten it, or use a coarser DEM");
  }
  return extras;
}

std::vector<Grid<float>> compute_with_extras(const planning::HazardMap& hazards, const DemSource& dem,
                                             const Window& window, const HazardExtras& extras) {
  const planning::LandingMargin margin =
      extras.landing ? planning::landing_margin(*extras.landing) : planning::LandingMargin{};
  const Window inner{margin.columns, margin.rows, window.columns, window.rows};
  planning::HazardTile tile =
      hazards.compute({window.column - margin.columns, window.row - margin.rows,
                       window.columns + 2 * margin.columns, window.rows + 2 * margin.rows});
  std::vector<Grid<float>> bands;
  if (extras.landing) {
    for (const Grid<float>& band : tile) bands.push_back(cropped(band, inner));
    Grid<float>& safe = tile[static_cast<std::size_t>(planning::HazardBand::probability)];
    for (float& p : safe.cells()) p = 1 - p;
    bands.push_back(planning::landing_safety(safe, inner, *extras.landing));
  } else {
    bands.assign(std::make_move_iterator(tile.begin()), std::make_move_iterator(tile.end()));
  }
  if (extras.ray) {
    const planning::HorizonMargin m = planning::horizon_margin(*extras.ray);
    const HeightWindow heights =
        dem.read({window.column - m.west, window.row - m.north, window.columns + m.west + m.east,
                  window.rows + m.north + m.south});
    Grid<float> horizon =
        planning::sun_horizon(heights, {m.west, m.north, window.columns, window.rows}, *extras.ray);
    Grid<float> shade = horizon;
    for (float& s : shade.cells())
      if (!std::isnan(s)) s = s > static_cast<float>(extras.sun_elevation) ? 1.0F : 0.0F;
    bands.push_back(std::move(horizon));
    bands.push_back(std::move(shade));
  }
  return bands;
}

}  // namespace waymark::workflows
