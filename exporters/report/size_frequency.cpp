// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/size_frequency.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exporters/formatting.hpp"
#include "exporters/report/log_plot.hpp"

namespace waymark::exporters {
namespace {

constexpr std::size_t kMinCount = 5;

std::string length_text(double metres) {
  const bool far = metres >= 1000;
  const double value = far ? metres / 1000 : metres;
  return number_text(value, value < 10 ? 2 : value < 100 ? 1 : 0) + (far ? "\u00a0km" : "\u00a0m");
}

std::string area_text(double square_metres) {
  const double km2 = square_metres / 1e6;
  if (km2 >= 0.01) return number_text(km2, km2 < 10 ? 3 : km2 < 100 ? 1 : 0) + "\u00a0km\u00b2";
  return number_text(square_metres, square_metres < 100 ? 1 : 0) + "\u00a0m\u00b2";
}

}  // namespace

double SizeBin::middle() const {
  return std::sqrt(from * to);
}

std::vector<SizeBin> size_bins(const std::vector<double>& diameters) {
  const auto step_of = [](double metres) {
    return static_cast<int>(std::floor(2 * std::log2(metres / 1000)));
  };
  const auto edge = [](int step) { return 1000 * std::exp2(step / 2.0); };
  const auto [smallest, largest] = std::ranges::minmax(diameters);
  const int first = step_of(smallest), last = step_of(largest);
  std::vector<SizeBin> bins;
  for (int step = first; step <= last; ++step) bins.push_back({edge(step), edge(step + 1), 0, 0});
  for (const double diameter : diameters) ++bins[static_cast<std::size_t>(step_of(diameter) - first)].count;
  std::int64_t larger = 0;
  for (auto bin = bins.rbegin(); bin != bins.rend(); ++bin) bin->larger = larger += bin->count;
  return bins;
}

double relative_density(const SizeBin& bin, double square_metres) {
  const double middle = bin.middle() / 1000, width = (bin.to - bin.from) / 1000;
  return std::pow(middle, 3) * static_cast<double>(bin.count) / (width * square_metres / 1e6);
}

std::string size_frequency_figures(const LandmarkSection& section, const std::optional<CountingArea>& area) {
  const auto size = find_feature(section.type, section.type.body.feature);
  if (section.type.evidence != EvidenceModel::bowl || !size) return {};
  std::vector<double> diameters;
  for (const double value : section.values[*size])
    if (value > 0) diameters.push_back(2 * section.type.body.radius_per_value * value);
  if (diameters.size() < kMinCount) return {};
  const auto bins = size_bins(diameters);
  const bool far = bins.back().to >= 2000;  // kilometres read better
  const double unit = far ? 1000 : 1;
  const std::string x_label = far ? "Diameter, km" : "Diameter, m";

  LogPlot cumulative{.title = "Cumulative size-frequency",
                     .about = "",
                     .x_label = x_label,
                     .y_label = area ? "At smallest as large, per km\u00b2" : "At smallest as large",
                     .colour = section.type.colour,
                     .points = {}};
  LogPlot relative{
      .title = "R-plot",
      .about =
          "Density relative to a population that falls with the cube of the diameter; bins grow by "
          "\u221a2, bars are \u221aN",
      .x_label = x_label,
      .y_label = "R = D\u00b3 N / (A \u0394D)",
      .colour = section.type.colour,
      .points = {}};
  cumulative.about = area ? fmt::format("Counted on {}: {}", area_text(area->square_metres), area->source)
                          : "The counting area is unknown";
  const double per_area = area ? 1e6 / area->square_metres : 1;
  for (const SizeBin& bin : bins) {
    if (bin.count == 0) continue;
    const auto n = static_cast<double>(bin.count), larger = static_cast<double>(bin.larger);
    const std::string range = length_text(bin.from) + " \u2013 " + length_text(bin.to);
    cumulative.points.push_back(
        {bin.from / unit, larger * per_area, std::sqrt(larger) * per_area,
         fmt::format("{} of at smallest {}", number_text(larger), length_text(bin.from))});
    if (!area) continue;
    const double r = relative_density(bin, area->square_metres);
    relative.points.push_back(
        {bin.middle() / unit, r, r / std::sqrt(n), fmt::format("{}: {}", range, number_text(n))});
  }
  const std::string figures = log_plot_figure(cumulative) + log_plot_figure(relative);
  return figures.empty() ? "" : "<div class='histograms plots'>" + figures + "</div>\n";
}

}  // namespace waymark::exporters
