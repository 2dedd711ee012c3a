// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "exporters/formatting.hpp"
#include "exporters/report/reconstruction_report.hpp"

namespace waymark::exporters {
namespace {

constexpr double kPlanWidth = 900, kMaxPlanHeight = 900;
constexpr std::size_t kMaxDots = 3000;      // tie points drawn
constexpr std::size_t kMaxPlanLabels = 40;  // more names would hide the plan

/// Map of the plan to the picture. Arbitrary frames are those of a camera, whose y points down.
struct PlanView {
  double up = 1, west = 0, north = 0, scale = 1, width = 0, height = 0;

  Eigen::Vector2d at(const Eigen::Vector2d& p) const {
    return {(p.x() - west) * scale, (north - up * p.y()) * scale};
  }
};

std::optional<PlanView> plan_view(const ReconstructionReport& report) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  const double up = report.metric ? 1 : -1;
  const auto include = [&](const Eigen::Vector2d& p) {
    low = low.cwiseMin(Eigen::Vector2d(p.x(), up * p.y()));
    high = high.cwiseMax(Eigen::Vector2d(p.x(), up * p.y()));
  };
  for (const ReportedImage& image : report.images) {
    if (image.centre) include(image.centre->head<2>());
    for (const Eigen::Vector2d& corner : image.footprint) include(corner);
  }
  const Eigen::Vector2d size = high - low;
  if (!(size.minCoeff() >= 0) || !(size.maxCoeff() > 0)) return std::nullopt;
  const double margin = 0.04 * size.maxCoeff();
  PlanView view{.up = up, .west = low.x() - margin, .north = high.y() + margin};
  view.scale = std::min(kPlanWidth / (size.x() + 2 * margin), kMaxPlanHeight / (size.y() + 2 * margin));
  view.width = view.scale * (size.x() + 2 * margin);
  view.height = view.scale * (size.y() + 2 * margin);
  return view;
}

std::string footprints(const ReconstructionReport& report, const PlanView& view) {
  std::string svg;
  for (const ReportedImage& image : report.images) {
    if (image.footprint.size() < 3) continue;
    std::string corners;
    for (const Eigen::Vector2d& corner : image.footprint) {
      const Eigen::Vector2d at = view.at(corner);
      corners += fmt::format("{:.1f},{:.1f} ", at.x(), at.y());
    }
    svg += fmt::format(
        "<polygon points='{}' fill='#3c78b4' fill-opacity='.07' stroke='#3c78b4' stroke-opacity='.6'/>",
        corners);
  }
  return svg;
}

std::string dots(const ReconstructionReport& report, const PlanView& view) {
  std::string path;
  const std::size_t step = report.points.size() / kMaxDots + 1;
  for (std::size_t i = 0; i < report.points.size(); i += step) {
    const Eigen::Vector2d at = view.at(report.points[i].head<2>());
    if (at.x() < 0 || at.y() < 0 || at.x() > view.width || at.y() > view.height) continue;
    path += fmt::format("M{:.1f} {:.1f}h1", at.x(), at.y());
  }
  return path.empty() ? "" : fmt::format("<path d='{}' stroke='#777' stroke-width='1' fill='none'/>", path);
}

std::string cameras(const ReconstructionReport& report, const PlanView& view) {
  std::string svg;
  const bool named = report.images.size() <= kMaxPlanLabels;
  for (const ReportedImage& image : report.images) {
    if (!image.centre) continue;
    const Eigen::Vector2d at = view.at(image.centre->head<2>());
    svg += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='4' fill='#c8501e'><title>{}</title></circle>",
                       at.x(), at.y(), escape_markup(image.name));
    if (named)
      svg += fmt::format("<text x='{:.1f}' y='{:.1f}' font-size='10' fill='currentColor'>{}</text>",
                         at.x() + 6, at.y() - 4, escape_markup(image.name));
  }
  return svg;
}

std::string surveyed(const ReconstructionReport& report, const PlanView& view) {
  std::string svg;
  for (const ReportedPoint& point : report.control) {
    const Eigen::Vector2d at = view.at(point.at.head<2>());
    const char* colour = point.check ? "#1b8a5a" : point.used ? "#111" : "#d0021b";
    svg += fmt::format(
        "<path d='M{:.1f} {:.1f}l6 10h-12z' fill='{}' stroke='#fff' "
        "stroke-width='.8'><title>{}</title></path>",
        at.x(), at.y() - 6, colour, escape_markup(point.name));
  }
  return svg;
}

// A round length of about a fifth of the width.
std::string scale_bar(const ReconstructionReport& report, const PlanView& view) {
  const double about = view.width / view.scale / 5, decade = std::pow(10, std::floor(std::log10(about)));
  const double length = decade * (about / decade >= 5 ? 5 : about / decade >= 2 ? 2 : 1);
  return fmt::format(
      "<path d='M12 {0:.1f}h{1:.1f}' stroke='currentColor' stroke-width='3'/><text x='12' y='{2:.1f}' "
      "font-size='12' fill='currentColor'>{3:g} {4}</text>",
      view.height - 12, length * view.scale, view.height - 18, length, report.metric ? "m" : "units");
}

}  // namespace

std::string plan_figure(const ReconstructionReport& report) {
  const auto view = plan_view(report);
  if (!view) return "";
  const bool surveyed_points = !report.control.empty();
  return fmt::format(
      "<figure class='map'><svg viewBox='-1 -1 {8:.1f} {9:.1f}' role='img' aria-label='Plan of the images'>"
      "{2}{3}{4}{5}{6}<rect class='frame' width='{0:.1f}' height='{1:.1f}'/></svg><figcaption class='legend'>"
      "<span>orange: cameras</span><span>blue: what they see</span><span>grey: tie points</span>{7}"
      "</figcaption></figure>\n",
      view->width, view->height, footprints(report, *view), dots(report, *view), cameras(report, *view),
      surveyed(report, *view), scale_bar(report, *view),
      surveyed_points ? "<span>triangles: control (black), check (green), left out (red)</span>" : "",
      view->width + 2, view->height + 2);
}

}  // namespace waymark::exporters
