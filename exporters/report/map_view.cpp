// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/map_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "exporters/formatting.hpp"

namespace waymark::exporters {
namespace {

constexpr double kLongSide = 1000;  // drawing units

std::string degrees_text(double value, int decimals, const char* positive, const char* negative) {
  return fmt::format("{}\u00b0\u00a0{}", number_text(std::abs(value), decimals),
                     value < 0 ? negative : positive);
}

std::string longitude_text(const Crs& crs, double x, int decimals) {
  // Planetary longitudes run east from 0 to 360; on Earth they are E or W up to 180.
  const double lon = crs.body().name == earth().name ? std::remainder(x, 360) : x;
  return degrees_text(lon, decimals, "E", "W");
}

int decimals_of(double step) {
  return step >= 1 ? 0 : static_cast<int>(std::ceil(-std::log10(step) - 1e-9));
}

/// Returns a round step that divides `length` into about `wanted` parts; for degrees one that divides 90.
double graticule_step(double length, double wanted, bool degrees) {
  const double step = length / wanted;
  if (degrees)
    for (const double round : {2.0, 5.0, 10.0, 15.0, 30.0, 45.0, 60.0})
      if (step > 1 && step <= round) return round;
  return round_length(2 * step);
}

std::string line_text(const MapView& view, double value, double step, bool is_x) {
  if (view.crs.kind() == CrsKind::geographic)
    return is_x ? longitude_text(view.crs, value, decimals_of(step))
                : degrees_text(value, decimals_of(step), "N", "S");
  if (view.crs.metres_per_unit() == 1 && step >= 1000) return number_text(value / 1000) + "\u00a0km";
  return number_text(value, decimals_of(step));
}

/// Returns the direction of true north in the middle of the view, degrees clockwise from up.
double north_of(const MapView& view) {
  if (view.crs.kind() != CrsKind::projected) return 0;
  try {
    const Crs geographic = geographic_crs(view.crs);
    const double x = view.extent.west + view.extent.width() / 2,
                 y = view.extent.south + view.extent.height() / 2;
    const auto here = CrsTransform(view.crs, geographic)(x, y);
    const auto north = CrsTransform(geographic, view.crs)(here.x, here.y + (here.y > 89.98 ? -0.01 : 0.01));
    const double angle = std::atan2(north.x - x, north.y - y) / kRadiansPerDegree;
    return !std::isfinite(angle) ? 0 : here.y > 89.98 ? angle + 180 : angle;
  } catch (const Error&) {
    return 0;  // a CRS without inverse: up is taken as north
  }
}

}  // namespace

double MapView::unwrap(double map_x) const {
  if (crs.kind() != CrsKind::geographic) return map_x;
  const double middle = extent.west + extent.width() / 2;
  return map_x - 360 * std::round((map_x - middle) / 360);
}

MapView view_of(const Crs& crs, const Extent& extent) {
  MapView view{crs, extent, ground_scale(crs, extent)};
  const double width = extent.width() * view.scale.x, height = extent.height() * view.scale.y;
  view.width = kLongSide * std::min(1.0, width / height);
  view.height = kLongSide * std::min(1.0, height / width);
  return view;
}

std::optional<Extent> extent_of(const std::vector<LandmarkSection>& sections, const Crs& crs) {
  std::optional<Extent> extent, eastern;
  const auto unite = [](std::optional<Extent>& all, const std::optional<Extent>& one) {
    if (one) all = all ? all->united(*one) : one;
  };
  for (const LandmarkSection& section : sections) {
    unite(extent, section.extent);
    unite(eastern, section.eastern_extent);
  }
  if (!extent) return {};
  // Across the antimeridian longitudes from 0 to 360 are the shorter way.
  if (crs.kind() == CrsKind::geographic && eastern && eastern->width() < extent->width()) extent = eastern;
  const double kilometre = crs.kind() == CrsKind::geographic
                               ? 1000 / (crs.body().mean_radius() * kRadiansPerDegree)
                           : crs.kind() == CrsKind::local ? 1
                                                          : 1000 / crs.metres_per_unit();
  const double margin = std::max(0.04 * std::max(extent->width(), extent->height()), kilometre / 2);
  return Extent{extent->west - margin, extent->south - margin, extent->east + margin, extent->north + margin};
}

std::string position_text(const Crs& crs, double x, double y) {
  switch (crs.kind()) {
    case CrsKind::geographic:
      return degrees_text(y, 4, "N", "S") + " " + longitude_text(crs, x, 4);
    case CrsKind::projected:
      return fmt::format("E\u00a0{} N\u00a0{}", number_text(x, 1), number_text(y, 1));
    case CrsKind::local:
      return fmt::format("x\u00a0{} y\u00a0{}", number_text(x, 2), number_text(y, 2));
  }
  return {};
}

std::string svg_graticule(const MapView& view) {
  const bool degrees = view.crs.kind() == CrsKind::geographic;
  const double step_x = graticule_step(view.extent.width(), view.width / 130, degrees);
  const double step_y = graticule_step(view.extent.height(), view.height / 130, degrees);
  std::string lines, texts;
  for (double i = std::ceil(view.extent.west / step_x); i * step_x <= view.extent.east; ++i) {
    const double x = view.x(i * step_x);
    lines += fmt::format("M{:.1f} 0V{:.1f}", x, view.height);
    texts += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='middle'>{}</text>", x, view.height + 20,
                         line_text(view, i * step_x, step_x, true));
  }
  for (double i = std::ceil(view.extent.south / step_y); i * step_y <= view.extent.north; ++i) {
    const double y = view.y(i * step_y);
    lines += fmt::format("M0 {:.1f}H{:.1f}", y, view.width);
    texts += fmt::format("<text x='-10' y='{:.1f}' text-anchor='end'>{}</text>", y + 4,
                         line_text(view, i * step_y, step_y, false));
  }
  return fmt::format("<path class='graticule' d='{}'/><g class='coordinates'>{}</g>", lines, texts);
}

std::string svg_scale_bar(const MapView& view) {
  const double metres = round_length(view.metres_per_unit() * view.width / 4);
  const double length = metres / view.metres_per_unit();
  std::string text =
      metres >= 1000 ? number_text(metres / 1000) + " km" : number_text(metres, decimals_of(metres)) + " m";
  const double middle = (view.extent.south + view.extent.north) / 2;
  if (view.crs.kind() == CrsKind::geographic && view.extent.height() > 5)
    text += " at " + degrees_text(middle, 0, "N", "S");
  const double half = length / 2;
  return fmt::format(
      "<g class='scale' transform='translate(22 {:.1f})'>"
      "<rect class='plate' x='-10' y='-26' width='{:.1f}' height='38' rx='4'/>"
      "<rect class='dark' width='{:.2f}' height='5'/><rect class='light' x='{:.2f}' width='{:.2f}' "
      "height='5'/>"
      "<text x='0' y='-8'>{}</text></g>",
      view.height - 24, std::max(length, 9.0 * static_cast<double>(text.size())) + 20, half, half, half,
      text);
}

std::string svg_north_arrow(const MapView& view) {
  if (view.crs.kind() == CrsKind::local) return {};
  return fmt::format(
      "<g class='north' transform='translate({:.1f} 40) rotate({:.1f})'><circle class='plate' r='25'/>"
      "<path class='dark' d='M0 -19L8 10L0 5Z'/><path class='light' d='M0 -19L-8 10L0 5Z'/>"
      "<text y='20' text-anchor='middle'>N</text></g>",
      view.width - 40, north_of(view));
}

double round_length(double at_most) {
  const double power = std::pow(10, std::floor(std::log10(at_most)));
  for (const double digit : {5.0, 2.0})
    if (digit * power <= at_most * (1 + 1e-9)) return digit * power;
  return power;
}

}  // namespace waymark::exporters
