// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/histogram.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exporters/formatting.hpp"
#include "exporters/report/map_view.hpp"

namespace waymark::exporters {
namespace {

constexpr double kWidth = 360, kHeight = 150;  // of the bars, drawing units
constexpr double kLogSpan = 30;
constexpr double kTickGap = 48;  // between coordinates on the axis

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Returns the position of a value on the axis, drawing units.
double place(const Histogram& histogram, double value) {
  const auto at = [&](double v) { return histogram.logarithmic ? std::log(v) : v; };
  const double from = at(histogram.edges.front()), to = at(histogram.edges.back());
  return to > from ? kWidth * (at(value) - from) / (to - from) : 0;
}

std::vector<double> round_values(const Histogram& histogram) {
  const double from = histogram.edges.front(), to = histogram.edges.back();
  std::vector<double> ticks;
  if (!histogram.logarithmic) {
    const double step = round_length((to - from) / 3);
    for (double i = std::ceil(from / step - 1e-9); i * step <= to * (1 + 1e-12) + 1e-9 * step; ++i)
      ticks.push_back(i * step);
    return ticks;
  }
  for (double power = std::pow(10, std::floor(std::log10(from))); power <= to; power *= 10)
    for (const double digit : {1.0, 2.0, 5.0})
      if (digit * power >= from * (1 - 1e-9) && digit * power <= to) ticks.push_back(digit * power);
  return ticks;
}

std::string svg_bars(const Histogram& histogram, const NumberFormat& read) {
  const auto highest = *std::max_element(histogram.counts.begin(), histogram.counts.end());
  std::string bars;
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    if (histogram.counts[i] == 0) continue;
    const double left = place(histogram, histogram.edges[i]),
                 right = place(histogram, histogram.edges[i + 1]);
    const double height =
        std::max(1.0, kHeight * static_cast<double>(histogram.counts[i]) / static_cast<double>(highest));
    bars += fmt::format(
        "<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}'><title>{} \u2013 {}: {}</title></rect>",
        left + 0.5, kHeight - height, std::max(1.0, right - left - 1), height,
        read.number(histogram.edges[i]), escape_markup(read(histogram.edges[i + 1])),
        number_text(static_cast<double>(histogram.counts[i])));
  }
  return bars;
}

std::string svg_axis(const Histogram& histogram, const FeatureSpec& feature, double largest) {
  Histogram shown = histogram;  // round numbers in the displayed unit, not in the stored one
  const NumberFormat read = number_format(feature, largest);
  for (double& edge : shown.edges) edge *= read.factor;
  std::string axis;
  double free_from = -kTickGap;
  for (const double tick : round_values(shown)) {
    const double x = place(shown, tick);
    axis += fmt::format("<path d='M{:.1f} {}v4'/>", x, kHeight);
    if (x < free_from) continue;
    const int decimals = tick != 0 && std::abs(tick) < 1
                             ? static_cast<int>(std::ceil(-std::log10(std::abs(tick)) - 1e-9))
                         : tick == std::floor(tick) ? 0
                                                    : 1;
    axis += fmt::format("<text x='{:.1f}' y='{}' text-anchor='middle'>{}</text>", x, kHeight + 18,
                        number_text(tick, decimals));
    free_from = x + kTickGap;
  }
  return axis;
}

std::string figure(const LandmarkSection& section, std::size_t f) {
  const FeatureSpec& feature = section.type.features[f];
  const std::vector<double>& values = section.values[f];
  if (values.size() < 2) return {};
  const Histogram histogram = histogram_of(values, feature.scale);
  const double largest = *std::max_element(values.begin(), values.end());
  const NumberFormat read = number_format(feature, largest);
  const double median = median_of(values), x = place(histogram, median);
  const std::string title = title_of(feature.name) + (read.unit.empty() ? "" : ", " + read.unit);
  return fmt::format(
      "<figure class='histogram' style='--type:{}'><figcaption><b>{}</b> {}</figcaption>"
      "<svg viewBox='-14 -18 {} {}' role='img' aria-label='Histogram of {}'>{}<g class='axis'><path d='M0 "
      "{}H{}'/>{}"
      "</g><g class='median'><path d='M{:.1f} -2V{}'/><text x='{:.1f}' y='-6' text-anchor='{}'>median "
      "{}</text></g>"
      "</svg></figure>\n",
      escape_markup(section.type.colour), escape_markup(title), escape_markup(feature.summary), kWidth + 28,
      kHeight + 42, escape_markup(feature.name), svg_bars(histogram, read), kHeight, kWidth,
      svg_axis(histogram, feature, largest), x, kHeight, x,
      x < kWidth * 0.2   ? "start"
      : x > kWidth * 0.8 ? "end"
                         : "middle",
      escape_markup(read(median)));
}

}  // namespace

Histogram histogram_of(const std::vector<double>& values, Scale scale) {
  const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
  const double low = *lowest, high = *highest;
  Histogram histogram;
  histogram.logarithmic = scale == Scale::ratio && low > 0 && high / low > kLogSpan;
  const auto wanted =
      static_cast<std::size_t>(std::clamp(2 * std::sqrt(static_cast<double>(values.size())), 6.0, 32.0));
  const std::size_t bins = high > low ? wanted : 1;
  const auto at = [&](double v) { return histogram.logarithmic ? std::log(v / low) : v - low; };
  for (std::size_t i = 0; i <= bins; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(bins);
    histogram.edges.push_back(histogram.logarithmic ? low * std::pow(high / low, share)
                                                    : low + (high - low) * share);
  }
  histogram.counts.assign(bins, 0);
  for (const double value : values) {
    const double share = high > low ? at(value) / at(high) : 0;
    ++histogram.counts[std::min(bins - 1, static_cast<std::size_t>(share * static_cast<double>(bins)))];
  }
  return histogram;
}

std::string histogram_figures(const LandmarkSection& section) {
  std::string figures;
  for (std::size_t i = 0; i < section.type.features.size(); ++i) figures += figure(section, i);
  return figures.empty() ? "" : "<div class='histograms'>" + figures + "</div>\n";
}

}  // namespace waymark::exporters
