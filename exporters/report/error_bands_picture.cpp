// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/error_bands_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/escape_markup.hpp"

namespace waymark::exporters {
namespace {

constexpr double kBandsWidth = 760, kBandsHeight = 340, kBandsLeft = 60, kBandsTop = 40, kBandsRight = 20,
                 kBandsBottom = 45;

struct BandAxes {
  double seconds = 1, metres = 1;

  double x(double t) const { return kBandsLeft + t / seconds * (kBandsWidth - kBandsLeft - kBandsRight); }
  double y(double e) const {
    return kBandsHeight - kBandsBottom - e / metres * (kBandsHeight - kBandsTop - kBandsBottom);
  }
  std::string point(double t, double e) const { return fmt::format("{:.1f},{:.1f} ", x(t), y(e)); }
};

/// Returns the smallest of 1, 2, 5 times a power of ten that is not below `value`.
double round_up_axis(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * power >= value) return step * power;
  return 10 * power;
}

using BandColumn = double localization::ErrorBand::*;

std::string band_area(std::span<const localization::ErrorBand> bands, const BandAxes& axes, BandColumn low,
                      BandColumn high, const char* colour) {
  std::string points;
  for (const auto& b : bands) points += axes.point(b.t, b.*high);
  for (std::size_t i = bands.size(); i-- > 0;) points += axes.point(bands[i].t, bands[i].*low);
  return fmt::format("<polygon points=\"{}\" fill=\"{}\"/>\n", points, colour);
}

std::string median_line(std::span<const localization::ErrorBand> bands, const BandAxes& axes,
                        BandColumn column, const char* style) {
  std::string points;
  for (const auto& b : bands) points += axes.point(b.t, b.*column);
  return fmt::format("<polyline points=\"{}\" fill=\"none\" {}/>\n", points, style);
}

std::string band_label(double x, double y, const char* anchor, const std::string& text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, text);
}

}  // namespace

std::string error_bands_picture(const std::string& title, std::span<const localization::ErrorBand> bands) {
  BandAxes axes;
  double largest = 1e-3;
  for (const auto& b : bands) {
    axes.seconds = std::max(axes.seconds, b.t);
    largest = std::max({largest, b.p95, b.claimed});
  }
  axes.metres = round_up_axis(largest);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      kBandsWidth, kBandsHeight);
  svg += band_label(kBandsWidth / 2, 22, "middle", escape_markup(title));
  svg += band_area(bands, axes, &localization::ErrorBand::p5, &localization::ErrorBand::p95, "#c6dbef");
  svg += band_area(bands, axes, &localization::ErrorBand::p25, &localization::ErrorBand::p75, "#6baed6");
  svg += median_line(bands, axes, &localization::ErrorBand::median, "stroke=\"#08306b\" stroke-width=\"2\"");
  svg += median_line(bands, axes, &localization::ErrorBand::claimed,
                     "stroke=\"#b22222\" stroke-dasharray=\"5 4\"");
  for (int i = 0; i <= 4; ++i) {
    const double e = axes.metres * i / 4, t = axes.seconds * i / 4;
    svg += fmt::format("<line x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#dddddd\"/>\n",
                       axes.x(0), axes.x(axes.seconds), axes.y(e), axes.y(e));
    svg += band_label(kBandsLeft - 6, axes.y(e) + 4, "end", fmt::format("{:g}", e));
    svg += band_label(axes.x(t), kBandsHeight - kBandsBottom + 16, "middle", fmt::format("{:.0f}", t));
  }
  svg += band_label(kBandsWidth / 2, kBandsHeight - 8, "middle", "time, s");
  svg += band_label(kBandsLeft, kBandsTop - 8, "start",
                    "position error, m: median, 50 % and 90 % of the drives; dashed: claimed sd");
  return svg + "</svg>\n";
}

}  // namespace waymark::exporters
