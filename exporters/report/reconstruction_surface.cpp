// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "exporters/formatting.hpp"
#include "exporters/report/base64.hpp"
#include "exporters/report/reconstruction_report.hpp"
#include "exporters/report/relief_picture.hpp"

namespace waymark::exporters {
namespace {

constexpr Colour kTransparent{0, 0, 0, 0};
constexpr std::array<Colour, 12> kReasonColours = {
    Colour{235, 235, 230}, Colour{40, 40, 40},   Colour{140, 140, 140}, Colour{40, 70, 150},
    Colour{120, 80, 50},   Colour{210, 50, 50},  Colour{240, 150, 40},  Colour{200, 60, 190},
    Colour{60, 160, 80},   Colour{80, 190, 200}, Colour{240, 220, 60},  Colour{150, 110, 220}};

std::string picture(const Grid<Colour>& cells, const std::string& caption, const std::string& legend = "") {
  return fmt::format(
      "<figure class='image'><svg viewBox='0 0 {0} {1}' role='img' aria-label='{2}'><image width='{0}' "
      "height='{1}' "
      "href='data:image/png;base64,{3}'/></svg><figcaption>{2}{4}</figcaption></figure>\n",
      cells.columns(), cells.rows(), escape_markup(caption), base64(encode_png(cells)), legend);
}

template <class T, class Use>
Grid<Colour> coloured(const Grid<T>& values, const Use& colour) {
  Grid<Colour> out(values.columns(), values.rows());
  std::ranges::transform(values.cells(), out.cells().begin(), colour);
  return out;
}

// Value that a fraction of the known cells does not exceed.
float quantile(const Grid<float>& values, double fraction) {
  std::vector<float> known;
  for (const float v : values.cells())
    if (std::isfinite(v)) known.push_back(v);
  if (known.empty()) return 0;
  const auto at = known.begin() + static_cast<std::ptrdiff_t>(fraction * double(known.size() - 1));
  std::nth_element(known.begin(), at, known.end());
  return *at;
}

Colour grey(float value, float dark, float bright) {
  if (!std::isfinite(value)) return kTransparent;
  const auto level = static_cast<std::uint8_t>(
      std::lround(255 * std::clamp((value - dark) / std::max(bright - dark, 1e-9F), 0.F, 1.F)));
  return {level, level, level};
}

// White to dark red.
Colour deviation_colour(float sd, float largest) {
  if (!std::isfinite(sd)) return kTransparent;
  const float t = std::clamp(sd / std::max(largest, 1e-9F), 0.F, 1.F);
  return {static_cast<std::uint8_t>(std::lround(255 - 105 * t)),
          static_cast<std::uint8_t>(std::lround(245 * (1 - t))),
          static_cast<std::uint8_t>(std::lround(225 * (1 - t)))};
}

std::string relief(const ReportedSurface& surface, const std::optional<Crs>& crs) {
  const double unit = crs && crs->kind() == CrsKind::projected ? crs->metres_per_unit() : 1;
  const double width = surface.cell * double(surface.heights.columns()),
               height = surface.cell * double(surface.heights.rows());
  const Relief seen{.extent = {.west = surface.west / unit,
                               .south = (surface.north - height) / unit,
                               .east = (surface.west + width) / unit,
                               .north = surface.north / unit},
                    .heights = surface.heights,
                    .cell_x = surface.cell,
                    .cell_y = surface.cell};
  const HypsometricTint tint = hypsometric_tint(seen, crs ? crs->body() : Crs::local().body());
  return picture(shade(seen, tint),
                 fmt::format("Shaded relief, {} to {} m; cells of {:.3g} m in dem.tif",
                             number_text(tint.lowest, 1), number_text(tint.highest, 1), surface.full_cell));
}

std::string reasons(const ReportedSurface& surface) {
  std::int64_t all = 0;
  for (const auto& [text, count] : surface.counts) all += count;
  std::string legend = "<div class='counts'>";
  for (std::size_t code = 0; code < surface.counts.size(); ++code) {
    const auto& [text, count] = surface.counts[code];
    if (count == 0) continue;
    const Colour c = kReasonColours[code % kReasonColours.size()];
    legend += fmt::format("<span><i style='background:rgb({} {} {})'></i>{}: {} ({:.1f} %)</span>", c.red,
                          c.green, c.blue, escape_markup(text), number_text(double(count)),
                          all > 0 ? 100 * double(count) / double(all) : 0);
  }
  return picture(coloured(surface.reasons,
                          [](std::uint8_t code) { return kReasonColours[code % kReasonColours.size()]; }),
                 "Reasons of no data, with numbers of cells", legend + "</div>");
}

}  // namespace

std::string surface_figures(const ReportedSurface& surface, const std::optional<Crs>& crs) {
  const float worst = quantile(surface.sd, 0.98);
  std::string html = "<div class='pictures'>" + relief(surface, crs);
  if (surface.brightness.columns() > 0) {
    const float dark = quantile(surface.brightness, 0.005), bright = quantile(surface.brightness, 0.995);
    html +=
        picture(coloured(surface.brightness, [&](float v) { return grey(v, dark, bright); }), "Orthophoto");
  }
  html +=
      picture(coloured(surface.sd, [&](float v) { return deviation_colour(v, worst); }),
              fmt::format("Standard deviation of the heights: white 0, dark red {:.3g} m or more", worst));
  return html + reasons(surface) + "</div>\n";
}

}  // namespace waymark::exporters
