// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/inventory_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/atomic_file.hpp"
#include "exporters/formatting.hpp"
#include "exporters/report/map_view.hpp"
#include "exporters/report/page_style.hpp"

namespace waymark::exporters {
namespace {

constexpr double kWidth = 1000;  // of the drawing
constexpr std::size_t kMaxCharts = 60;

constexpr const char* kStyle = R"css(
.stand { fill: #7cb47f; fill-opacity: .16; stroke: #5d4037; stroke-width: 1.6; fill-rule: evenodd; }
.stem { fill: #1b5e20; fill-opacity: .8; }
.stands { overflow-x: auto; }
.stands table { border-collapse: collapse; font-size: .88rem; font-variant-numeric: tabular-nums; }
.stands th, .stands td { padding: .3rem .6rem; text-align: right; border-bottom: 1px solid var(--line); white-space: normal; vertical-align: top; }
.stands th:first-child, .stands td:first-child { text-align: left; }
.stands td small { display: block; white-space: nowrap; }
.bars rect { fill: #558b2f; } .bars line { stroke: var(--ink); } .bars text { fill: var(--soft); font-size: 11px; }
.warnings { padding: .6rem 1rem; background: var(--warn); border-left: 4px solid var(--warn-line); }
@media print { body { max-width: none; padding: 0; font-size: 11px; } .histogram, tr { break-inside: avoid; } }
)css";

std::size_t column(const geodb::ShapeLayer& layer, std::string_view name) {
  for (std::size_t i = 0; i < layer.columns.size(); ++i)
    if (layer.columns[i].name == name) return i;
  return layer.columns.size();
}

double number(const geodb::Shape& row, std::size_t column) {
  if (column >= row.values.size()) return std::numeric_limits<double>::quiet_NaN();
  if (const auto* real = std::get_if<double>(&row.values[column])) return *real;
  if (const auto* whole = std::get_if<std::int64_t>(&row.values[column])) return static_cast<double>(*whole);
  return std::numeric_limits<double>::quiet_NaN();
}

std::string text(const geodb::Shape& row, std::size_t column) {
  const auto* words = column < row.values.size() ? std::get_if<std::string>(&row.values[column]) : nullptr;
  return words ? *words : "";
}

/// Transforms map coordinates to the drawing, north up.
struct Drawing {
  Eigen::Vector2d low{0, 0}, high{1, 1};
  double scale = 1;

  explicit Drawing(const InventoryPage& page) {
    const double huge = std::numeric_limits<double>::infinity();
    low = {huge, huge};
    high = -low;
    for (const geodb::ShapeLayer* layer : {&page.stands, &page.trees})
      for (const geodb::Shape& row : layer->rows)
        for (const geodb::ShapePart& part : row.parts)
          for (const auto& corner : part.outer) low = low.cwiseMin(corner), high = high.cwiseMax(corner);
    if (!(low.x() <= high.x())) low = {0, 0}, high = {1, 1};
    const Eigen::Vector2d margin = Eigen::Vector2d::Constant(std::max(0.02 * (high - low).maxCoeff(), 1e-9));
    low -= margin;
    high += margin;
    scale = kWidth / (high.x() - low.x());
  }
  double height() const { return (high.y() - low.y()) * scale; }
  double x(double east) const { return (east - low.x()) * scale; }
  double y(double north) const { return (high.y() - north) * scale; }
};

std::string path_of(const Drawing& drawing, const geodb::Shape& row) {
  std::string d;
  const auto add = [&](const std::vector<Eigen::Vector2d>& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      d += fmt::format("{}{:.1f} {:.1f}", i == 0 ? 'M' : 'L', drawing.x(ring[i].x()), drawing.y(ring[i].y()));
    d += 'Z';
  };
  for (const geodb::ShapePart& part : row.parts) {
    add(part.outer);
    for (const auto& hole : part.holes) add(hole);
  }
  return d;
}

std::string map_figure(const InventoryPage& page) {
  const Drawing drawing(page);
  std::string svg = fmt::format(
      "<figure class=\"map\"><svg viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"Map of the "
      "stands\">\n",
      kWidth, drawing.height() + 34);
  const std::size_t name = column(page.stands, "stand"), crown = column(page.trees, "crown_diameter_m");
  for (const geodb::Shape& row : page.stands.rows)
    svg += fmt::format("<path class=\"stand\" d=\"{}\"><title>{}</title></path>\n", path_of(drawing, row),
                       escape_markup(text(row, name)));
  for (const geodb::Shape& row : page.trees.rows) {
    if (row.parts.empty()) continue;
    const double width = number(row, crown),
                 radius = std::isnan(width) ? 1.5 : std::max(0.6, width * 0.2 * drawing.scale);
    svg += fmt::format("<circle class=\"stem\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\"/>",
                       drawing.x(row.parts[0].outer[0].x()), drawing.y(row.parts[0].outer[0].y()),
                       std::min(radius, 12.0));
  }
  if (page.stands.rows.size() <= kMaxCharts) {
    svg += "\n<g class=\"labels\">";
    for (const geodb::Shape& row : page.stands.rows) {
      if (row.parts.empty()) continue;
      Eigen::Vector2d middle(0, 0);
      for (const auto& corner : row.parts[0].outer)
        middle += corner / static_cast<double>(row.parts[0].outer.size());
      svg += fmt::format("<text text-anchor=\"middle\" x=\"{:.0f}\" y=\"{:.0f}\">{}</text>",
                         drawing.x(middle.x()), drawing.y(middle.y()), escape_markup(text(row, name)));
    }
    svg += "</g>";
  }
  const double length = round_length((drawing.high.x() - drawing.low.x()) / 4);
  svg += fmt::format(
      "\n<g class=\"bars\"><line x1=\"10\" x2=\"{0:.1f}\" y1=\"{1:.0f}\" y2=\"{1:.0f}\" "
      "stroke-width=\"4\"/><text "
      "x=\"{2:.0f}\" y=\"{3:.0f}\">{4:g} (units of {5})</text></g></svg></figure>\n",
      10 + length * drawing.scale, drawing.height() + 14, 20 + length * drawing.scale, drawing.height() + 18,
      length, escape_markup(page.crs));
  if (page.trees.rows.size() < page.tree_count)
    svg += fmt::format("<p class=\"soft\">{} of {} trees are drawn.</p>", page.trees.rows.size(),
                       page.tree_count);
  return svg;
}

/// Returns true for stems_per_ha_d035, but not for its standard error nor for stems_per_ha_detected.
bool is_diameter_class(std::string_view column) {
  constexpr std::string_view kPrefix = "stems_per_ha_d";
  return column.starts_with(kPrefix) &&
         column.find_first_not_of("0123456789", kPrefix.size()) == std::string_view::npos;
}

struct TableColumn {
  const char *name, *title;
  int decimals;
};
constexpr TableColumn kTable[] = {{"stems_per_ha", "stems / ha", 0},
                                  {"stems_per_ha_detected", "stems / ha of detected trees", 0},
                                  {"basal_area_m2_per_ha", "basal area m²/ha", 1},
                                  {"basal_area_m2_per_ha_detected", "basal area m²/ha of detected trees", 1},
                                  {"volume_m3_per_ha", "volume m³/ha", 0},
                                  {"volume_m3_per_ha_detected", "volume m³/ha of detected trees", 0},
                                  {"lorey_height_m", "Lorey height m", 1},
                                  {"dominant_height_m", "dominant height m", 1},
                                  {"quadratic_mean_diameter_cm", "quadratic mean diameter cm", 1},
                                  {"cover", "cover", 2},
                                  {"biomass_t_per_ha", "dry mass t/ha", 0}};

std::string table_of(const InventoryPage& page) {
  const geodb::ShapeLayer& stands = page.stands;
  std::string html = "<div class=\"stands\"><table><thead><tr><th>stand</th><th>ha</th><th>trees</th>";
  std::vector<TableColumn> shown;
  for (const TableColumn& c : kTable) {
    const std::size_t at = column(stands, c.name);
    if (std::ranges::any_of(stands.rows,
                            [&](const geodb::Shape& row) { return !std::isnan(number(row, at)); }))
      shown.push_back(c);
  }
  for (const TableColumn& c : shown) html += fmt::format("<th>{}</th>", c.title);
  html += "</tr></thead><tbody>\n";
  for (const geodb::Shape& row : stands.rows) {
    html += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td>",
                        escape_markup(text(row, column(stands, "stand"))),
                        number_text(number(row, column(stands, "area_ha")), 2),
                        number_text(number(row, column(stands, "trees"))));
    for (const TableColumn& c : shown) {
      const std::size_t at = column(stands, c.name);
      html += fmt::format("<td>{}<small>± {}</small></td>", number_text(number(row, at), c.decimals),
                          number_text(number(row, at + 1), std::min(c.decimals + 1, 3)));
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string chart_of(const geodb::ShapeLayer& stands, const geodb::Shape& row, double tallest) {
  constexpr double kHigh = 120, kWide = 300;
  std::string svg = fmt::format(
      "<figure class=\"histogram\"><h3>{}</h3><svg class=\"bars\" viewBox=\"-34 -8 {} {}\" role=\"img\" "
      "aria-label=\"Stems per hectare by diameter\">",
      escape_markup(text(row, column(stands, "stand"))), kWide + 44, kHigh + 40);
  std::vector<std::size_t> bins;
  for (std::size_t i = 0; i < stands.columns.size(); ++i)
    if (is_diameter_class(stands.columns[i].name)) bins.push_back(i);
  const double width = kWide / static_cast<double>(std::max<std::size_t>(bins.size(), 1));
  const std::size_t every = 1 + bins.size() / 10;
  for (std::size_t k = 0; k < bins.size(); ++k) {
    const double stems = number(row, bins[k]), error = number(row, bins[k] + 1);
    const double x = static_cast<double>(k) * width, y = kHigh * (1 - stems / tallest);
    svg += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>", x + 0.5, y,
                       std::max(width - 1, 0.5), kHigh - y);
    if (error > 0)
      svg += fmt::format("<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1:.1f}\" y2=\"{2:.1f}\"/>", x + width / 2,
                         std::max(kHigh * (1 - (stems + error) / tallest), -6.0),
                         kHigh * (1 - std::max(stems - error, 0.0) / tallest));
    if (k % every == 0)  // stems_per_ha_d035 begins at 35 cm
      svg += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>", x, kHigh + 14,
                         std::stoi(stands.columns[bins[k]].name.substr(14)));
  }
  return svg + fmt::format(
                   "<text x=\"-4\" y=\"4\" text-anchor=\"end\">{:.0f}</text><text x=\"-4\" y=\"{}\" "
                   "text-anchor=\"end\">0</text><text x=\"{}\" y=\"{}\" text-anchor=\"middle\">diameter, cm "
                   "(stems per hectare)</text></svg></figure>\n",
                   tallest, kHigh, kWide / 2, kHigh + 29);
}

std::string charts_of(const geodb::ShapeLayer& stands) {
  double tallest = 1;
  for (const geodb::Shape& row : stands.rows)
    for (std::size_t i = 0; i + 1 < stands.columns.size(); ++i)
      if (is_diameter_class(stands.columns[i].name)) tallest = std::max(tallest, number(row, i));
  std::string html = "<div class=\"histograms\">\n";
  for (std::size_t i = 0; i < std::min(stands.rows.size(), kMaxCharts); ++i)
    html += chart_of(stands, stands.rows[i], tallest);
  html += "</div>\n";
  if (stands.rows.size() > kMaxCharts)
    html += fmt::format("<p class=\"soft\">The first {} of {} stands.</p>\n", kMaxCharts, stands.rows.size());
  return html;
}

std::string fact(const std::string& value, const char* what) {
  return fmt::format("<li><b>{}</b><span>{}</span></li>", value, what);
}

}  // namespace

std::string inventory_html(const InventoryPage& page) {
  double hectares = 0, trees = 0;
  for (const geodb::Shape& row : page.stands.rows) {
    hectares += number(row, column(page.stands, "area_ha"));
    trees += number(row, column(page.stands, "trees"));
  }
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">{6}<meta name=\"viewport\" "
      "content=\"width=device-width\"><title>Inventory of {0}</title><style>{1}{2}</style></head><body>\n"
      "<header><h1>Inventory of {0}</h1></header>\n<ul class=\"facts\">{3}{4}{5}</ul>\n",
      escape_markup(page.title), kPageStyle, kStyle,
      fact(number_text(static_cast<double>(page.stands.rows.size())), "stands"),
      fact(number_text(hectares, 1) + " ha", "in all, overlaps twice"), fact(number_text(trees), "trees"),
      kContentPolicy);
  if (!page.warnings.empty() || !page.failed.empty()) {
    html += "<div class=\"warnings\"><ul>";
    for (const std::string& f : page.failed) html += "<li>Left out: " + escape_markup(f) + "</li>";
    for (const std::string& w : page.warnings) html += "<li>" + escape_markup(w) + "</li>";
    html += "</ul></div>\n";
  }
  html +=
      "<h2>Stands</h2>\n<p>Standard errors (±) include those of the single trees. Figures per hectare "
      "include "
      "undetected trees where the fraction of each height that is detected from the air, or a recall, is "
      "known; "
      "those “of detected trees” do not.</p>\n";
  html += table_of(page);
  html += "<h2>Map</h2>\n" + map_figure(page);
  html += "<h2>Diameters</h2>\n" + charts_of(page.stands);
  return html + "<footer>Made by <code>waymark inventory</code></footer></body></html>\n";
}

void write_inventory_report(const std::filesystem::path& path, const InventoryPage& page) {
  write_file(path, inventory_html(page));
}

}  // namespace waymark::exporters
