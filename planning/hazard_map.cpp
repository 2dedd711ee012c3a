// SPDX-License-Identifier: Apache-2.0
#include "planning/hazard_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "planning/relief_row.hpp"

namespace waymark::planning {
namespace {

BaseFootprint footprint_of(const DemSource& dem, const Vehicle& vehicle) {
  const Georeference& where = dem.geometry().where;
  const double metres = where.crs.metres_per_unit();
  return make_base_footprint(where.dx * metres, -where.dy * metres, vehicle.base_radius(),
                             vehicle.support_diameter());
}

/// Marks the cells of a row that lie inside the rings.
void mark_row(const std::vector<std::vector<Eigen::Vector2d>>& rings, double y, const Georeference& where,
              const Window& window, std::vector<char>& inside) {
  std::fill(inside.begin(), inside.end(), rings.empty() ? 1 : 0);
  std::vector<double> crossings;
  for (const auto& ring : rings)
    for (std::size_t i = 0, last = ring.size() - 1; i < ring.size(); last = i++) {
      const Eigen::Vector2d &a = ring[last], &b = ring[i];
      if ((a.y() > y) != (b.y() > y))
        crossings.push_back(a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y()));
    }
  std::ranges::sort(crossings);
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
    for (std::int64_t c = 0; c < window.columns; ++c) {
      const double x = where.x(double(window.column + c));
      if (x >= crossings[i] && x < crossings[i + 1]) inside[static_cast<std::size_t>(c)] = 1;
    }
}

HazardClass class_of(double probability, const HazardRequest& request) {
  if (std::isnan(probability)) return HazardClass::unknown;
  if (probability >= request.min_hazard) return HazardClass::hazard;
  return probability >= request.min_uncertain ? HazardClass::uncertain : HazardClass::safe;
}

}  // namespace

Uncertain undetected_density(const UndetectedRocks& rocks, bool surveyed) {
  if (!rocks.known) return {};
  const double end = surveyed ? rocks.detected_diameter : std::numeric_limits<double>::infinity();
  // Rocks of each diameter are as high as the height per diameter is spread; bins grow by 5 %.
  const auto density = [&](double k) {
    double sum = 0;
    for (double d = rocks.min_height / 3; k > 0 && d < std::min(end, 40 * rocks.min_height); d *= 1.05) {
      const double high = probability_above(rocks.height_per_diameter, rocks.min_height / (1.025 * d));
      if (high > 0) sum += high * rocks_per_square_metre(k, d, std::min(end, 1.05 * d));
    }
    return sum;
  };
  const double value = density(rocks.cover.k), high = density(rocks.cover.k + rocks.cover.sd);
  return {value, std::abs(high - value)};
}

Uncertain undetected_probability(const UndetectedRocks& rocks, bool surveyed, double area) {
  const Uncertain density = undetected_density(rocks, surveyed);
  const double none = std::exp(-density.value * area);
  return {1 - none, none * density.sd * area};
}

std::array<BandName, kHazardBands> hazard_band_names() {
  return {{{"slope", "deg"},
           {"slope_sd", "deg"},
           {"roughness", "m"},
           {"roughness_sd", "m"},
           {"step", "m"},
           {"step_sd", "m"},
           {"object", ""},
           {"undetected", ""},
           {"undetected_sd", ""},
           {"probability", ""},
           {"class", ""}}};
}

HazardMap::HazardMap(const DemSource& dem, HazardRequest request, std::vector<HazardObject> objects)
    : dem_(dem),
      request_(std::move(request)),
      objects_(std::move(objects)),
      base_(footprint_of(dem, request_.vehicle)),
      errors_(propagate_errors(base_, request_.errors)) {
  std::ranges::stable_sort(objects_, {}, [](const HazardObject& o) { return o.position.x(); });
  const double radius = request_.vehicle.base_radius();
  for (const HazardObject& object : objects_) {
    xs_.push_back(object.position.x());
    max_reach_ = std::max(max_reach_, reach_of(object, radius));
  }
  const double area = std::numbers::pi * radius * radius;
  for (const bool surveyed : {false, true})
    undetected_[surveyed] = undetected_probability(request_.undetected, surveyed, area);
}

double HazardMap::fitted_radius() const {
  return double(base_.half_widths[0]) * base_.cell_x;
}

HazardTile HazardMap::compute(const Window& window) const {
  const Georeference& where = dem_.geometry().where;
  const std::int64_t mx = base_.half_columns, my = base_.half_rows;
  const HeightWindow heights =
      dem_.read({window.column - mx, window.row - my, window.columns + 2 * mx, window.rows + 2 * my});
  const Grid<BaseRelief> relief = fit_base(heights, {mx, my, window.columns, window.rows}, base_);

  const auto first = std::ranges::lower_bound(xs_, where.x(double(window.column)) - max_reach_) - xs_.begin();
  const auto last =
      std::ranges::upper_bound(xs_, where.x(double(window.end_column())) + max_reach_) - xs_.begin();
  const std::span near = std::span(objects_).subspan(
      static_cast<std::size_t>(first), static_cast<std::size_t>(std::max(last - first, std::ptrdiff_t{0})));
  HazardTile tile;
  for (Grid<float>& band : tile)
    band = Grid<float>(window.columns, window.rows, std::numeric_limits<float>::quiet_NaN());
  const auto band = [&](HazardBand b) -> Grid<float>& { return tile[static_cast<std::size_t>(b)]; };
  band(HazardBand::object) = object_hazard(near, window, where, request_.vehicle.base_radius());

  std::vector<char> inside(static_cast<std::size_t>(window.columns));
  ReliefRow assessed(errors_, request_.vehicle);
  for (std::int64_t r = 0; r < window.rows; ++r) {
    mark_row(request_.undetected.surveyed, where.y(double(window.row + r)), where, window, inside);
    const auto row = [&](HazardBand b) { return band(b).row(r); };
    const auto fits = relief.row(r);
    const auto probabilities = assessed.assess(
        fits, {row(HazardBand::slope), row(HazardBand::slope_sd), row(HazardBand::roughness),
               row(HazardBand::roughness_sd), row(HazardBand::step), row(HazardBand::step_sd)});
    const auto object = row(HazardBand::object), undetected = row(HazardBand::undetected),
               undetected_sd = row(HazardBand::undetected_sd), probability = row(HazardBand::probability),
               hazard_class = row(HazardBand::hazard_class);
    for (std::size_t c = 0; c < fits.size(); ++c) {
      const Uncertain& missed = undetected_[inside[c] != 0];
      double whole = std::nan("");
      if (!std::isnan(fits[c].step)) {
        if (request_.undetected.known)
          undetected[c] = static_cast<float>(missed.value), undetected_sd[c] = static_cast<float>(missed.sd);
        whole = 1 - (1 - probabilities[c]) * (1 - double(object[c])) * (1 - missed.value);
      } else if (object[c] >= static_cast<float>(request_.min_hazard)) {
        whole = object[c];  // a known rock on unknown terrain
      }
      probability[c] = static_cast<float>(whole);
      hazard_class[c] = static_cast<float>(class_of(static_cast<float>(whole), request_));
    }
  }
  return tile;
}

}  // namespace waymark::planning
