// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
namespace waymark::exporters {

/// A point with its standard deviation; x, y > 0.
struct LogPoint {
  double x = 0, y = 0, sd = 0;
  std::string tip;  ///< tooltip
};

/// Points and texts of a plot.
struct LogPlot {
  std::string title, about, x_label, y_label;
  std::string colour;  ///< of the points
  std::vector<LogPoint> points;
};

/// Returns a plot with logarithmic axes and equal decades both ways, as an HTML figure. Bars extend one
/// deviation up and down, to the frame if y - sd is not above 0. Empty for fewer than two points.
std::string log_plot_figure(const LogPlot& plot);

}  // namespace waymark::exporters
