// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/log_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exporters/formatting.hpp"

namespace waymark::exporters {
namespace {

constexpr double kWidth = 340, kHeight = 300;                       // of the frame, drawing units
constexpr double kLeft = 66, kTop = 10, kRight = 14, kBottom = 48;  // around it
constexpr double kTickGap = 22;

/// Range of an axis, as logarithms.
struct Axis {
  double from = 0, to = 1;
  double length = 1;
  double place(double value) const { return length * (std::log10(value) - from) / (to - from); }
};

Axis axis_of(double lowest, double highest, double length) {
  const double low = std::log10(lowest), high = std::log10(highest);
  const double room = std::max(0.08 * (high - low), 0.12);
  return {low - room, high + room, length};
}

std::string superscript(int power) {
  constexpr const char* digits[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                    "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string text = power < 0 ? "\u207b" : "";
  for (const char c : std::to_string(std::abs(power))) text += digits[c - '0'];
  return text;
}

/// Formats a plain number if it is short: 0.01, 20, 5000; else a power of ten.
std::string tick_text(int digit, int power) {
  if (power >= -2 && power <= 3) return number_text(digit * std::pow(10, power), std::max(0, -power));
  return (digit == 1 ? "" : std::to_string(digit) + "\u00b7") + ("10" + superscript(power));
}

/// Draws the ticks of an axis: each decade, and 2 and 5 in between if there is room.
template <class Draw>
void for_ticks(const Axis& axis, const Draw& draw) {
  const double decade = axis.length / (axis.to - axis.from);
  for (int power = static_cast<int>(std::floor(axis.from)); power <= axis.to; ++power)
    for (int digit = 1; digit < 10; ++digit) {
      const double at = power + std::log10(digit);
      if (at < axis.from || at > axis.to) continue;
      const bool labelled = digit == 1 || ((digit == 2 || digit == 5) && decade > 5 * kTickGap);
      draw(axis.length * (at - axis.from) / (axis.to - axis.from), digit, power, labelled);
    }
}

std::string svg_axes(const Axis& x, const Axis& y, const LogPlot& plot) {
  std::string grid, ticks, texts;
  for_ticks(x, [&](double at, int digit, int power, bool labelled) {
    ticks += fmt::format("M{:.1f} {}v{}", at, kHeight, labelled ? 5 : 3);
    if (digit == 1) grid += fmt::format("M{:.1f} 0V{}", at, kHeight);
    if (labelled)
      texts += fmt::format("<text x='{:.1f}' y='{}' text-anchor='middle'>{}</text>", at, kHeight + 19,
                           tick_text(digit, power));
  });
  for_ticks(y, [&](double along, int digit, int power, bool labelled) {
    const double at = kHeight - along;
    ticks += fmt::format("M0 {:.1f}h{}", at, labelled ? -5 : -3);
    if (digit == 1) grid += fmt::format("M0 {:.1f}H{}", at, kWidth);
    if (labelled)
      texts +=
          fmt::format("<text x='-9' y='{:.1f}' text-anchor='end'>{}</text>", at + 4, tick_text(digit, power));
  });
  texts += fmt::format(
      "<text x='{}' y='{}' text-anchor='middle'>{}</text><text transform='translate({} {}) rotate(-90)' "
      "text-anchor='middle'>{}</text>",
      kWidth / 2, kHeight + 40, escape_markup(plot.x_label), 14 - kLeft, kHeight / 2,
      escape_markup(plot.y_label));
  return fmt::format("<path class='grid' d='{}'/><g class='axis'><path d='M0 0V{}H{}{}'/>{}</g>", grid,
                     kHeight, kWidth, ticks, texts);
}

std::string svg_points(const Axis& x, const Axis& y, const LogPlot& plot) {
  std::string bars, dots;
  for (const LogPoint& point : plot.points) {
    const double at = x.place(point.x), height = kHeight - y.place(point.y);
    const double top = std::max(0.0, kHeight - y.place(point.y + point.sd));
    const double low =
        point.sd < point.y ? std::min(kHeight, kHeight - y.place(point.y - point.sd)) : kHeight;
    bars += fmt::format("M{:.1f} {:.1f}V{:.1f}", at, top, low);
    dots += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='3.4'><title>{}</title></circle>", at, height,
                        escape_markup(point.tip));
  }
  return fmt::format("<path class='deviation' d='{}'/>{}", bars, dots);
}

}  // namespace

std::string log_plot_figure(const LogPlot& plot) {
  if (plot.points.size() < 2) return {};
  const auto [left, right] = std::ranges::minmax(plot.points, {}, &LogPoint::x);
  const auto [lowest, highest] = std::ranges::minmax(plot.points, {}, &LogPoint::y);
  const Axis x = axis_of(left.x, right.x, kWidth), y = axis_of(lowest.y, highest.y, kHeight);
  return fmt::format(
      "<figure class='histogram plot' style='--type:{}'><figcaption><b>{}</b> {}</figcaption>"
      "<svg viewBox='{} {} {} {}' role='img' aria-label='{}'>{}<g class='points'>{}</g></svg></figure>\n",
      escape_markup(plot.colour), escape_markup(plot.title), escape_markup(plot.about), -kLeft, -kTop,
      kWidth + kLeft + kRight, kHeight + kTop + kBottom, escape_markup(plot.title), svg_axes(x, y, plot),
      svg_points(x, y, plot));
}

}  // namespace waymark::exporters
