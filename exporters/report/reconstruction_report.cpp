// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/reconstruction_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exporters/formatting.hpp"
#include "exporters/report/page_style.hpp"

namespace waymark::exporters {
namespace {

std::string cell(const std::string& text) {
  return "<td>" + text + "</td>";
}

std::string number_cell(double value, int decimals, bool known = true) {
  return cell(known ? number_text(value, decimals) : "\u2013");
}

// Decimals that show two digits of the largest value.
int decimals_for_sd(double largest) {
  return largest >= 10 ? 1 : largest >= 1 ? 2 : largest >= 0.1 ? 3 : 4;
}

std::string table(const std::string& caption, const std::vector<std::string>& headings,
                  const std::string& rows) {
  std::string head;
  for (const std::string& heading : headings) head += "<th scope='col'>" + heading + "</th>";
  return fmt::format(
      "<div class='scroll'><table class='stages'><caption>{}</caption><thead><tr>{}</tr></thead><tbody>\n{}"
      "</tbody></table></div>\n",
      caption, head, rows);
}

std::string row_head(const std::string& name) {
  return "<th scope='row'>" + escape_markup(name) + "</th>";
}

std::string images_table(const ReconstructionReport& report) {
  double largest = 0;
  for (const ReportedImage& image : report.images) largest = std::max(largest, image.position_sd);
  const int decimals = decimals_for_sd(largest);
  std::string rows;
  for (const ReportedImage& image : report.images) {
    if (!image.centre) continue;
    rows += "<tr>" + row_head(image.name) + number_cell(double(image.points), 0, image.points > 0) +
            number_cell(image.rms, 2, image.points > 0) +
            number_cell(image.position_sd, decimals, image.position_sd > 0) +
            number_cell(image.attitude_sd, 4, image.attitude_sd > 0) + number_cell(image.centre->x(), 2) +
            number_cell(image.centre->y(), 2) + number_cell(image.centre->z(), 2) + "</tr>\n";
  }
  const char* unit = report.metric ? " <small>m</small>" : "";
  return table("Standard deviations are the largest axes of the error ellipsoids",
               {"Image", "Tie points", "Residuals <small>px RMS</small>",
                std::string("Position \u00b1") + unit, "Attitude \u00b1 <small>degrees</small>",
                std::string("x") + unit, std::string("y") + unit, std::string("z") + unit},
               rows);
}

std::string control_table(const ReconstructionReport& report) {
  std::string rows;
  for (const ReportedPoint& p : report.control) {
    rows += "<tr>" + row_head(p.name) + cell(p.check ? "check" : p.used ? "control" : "<b>left out</b>");
    if (p.error) {
      for (int axis = 0; axis < 3; ++axis)
        rows += std::isnan((*p.error)[axis])
                    ? cell("not surveyed")
                    : cell(fmt::format(
                          "{:.3f}{}", (*p.error)[axis],
                          p.sd[axis] > 0 ? fmt::format("<small>\u00b1 {:.3f}</small>", p.sd[axis]) : ""));
      rows += number_cell(p.error->head<2>().norm(), 3) + number_cell(p.mark_rms, 2) +
              number_cell(p.statistic, 1);
    } else {
      rows += "<td colspan='6'>no position: it needs marks in two images with poses</td>";
    }
    rows += "</tr>\n";
  }
  return table(
      "Estimated minus surveyed, metres; a test statistic above 4 is a blunder. Check points are never used",
      {"Point", "Use", "East", "North", "Height", "In plan", "Marks <small>px RMS</small>", "Test"}, rows);
}

std::string lens_table(const ReconstructionReport& report) {
  std::string rows;
  for (const ReportedLensTerm& term : report.lenses)
    rows += "<tr>" + row_head(fmt::format("{}", term.lens + 1)) + cell(escape_markup(term.parameter)) +
            cell(fmt::format("{:.6g}", term.value)) +
            cell(term.admitted ? fmt::format("{:.2g}", term.sd) : "\u2013") +
            "<td style='text-align:left;white-space:normal'>" +
            escape_markup(term.admitted ? "adjusted" : "kept: " + term.reason) + "</td></tr>\n";
  return table("A term is adjusted only if the images determine it",
               {"Lens", "Term", "Value", "\u00b1", "Decision"}, rows);
}

std::string failures_table(const ReconstructionReport& report) {
  std::string rows;
  for (const auto& [image, reason] : report.failures)
    rows += "<tr>" + row_head(image) + "<td style='text-align:left;white-space:normal'>" +
            escape_markup(reason) + "</td></tr>\n";
  return table("Images without a pose", {"Image", "Reason"}, rows);
}

std::string list_of(const std::vector<std::string>& messages) {
  std::string items;
  for (const std::string& message : messages) items += "<li>" + escape_markup(message) + "</li>";
  return items.empty() ? "" : "<ul class='warnings'>" + items + "</ul>\n";
}

std::string section(const char* title, const std::string& html) {
  return fmt::format("<section><h2>{}</h2>\n{}</section>\n", title, html);
}

}  // namespace

std::string reconstruction_page(const ReconstructionReport& report) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang='en'>\n<head>\n<meta charset='utf-8'>\n{3}\n"
      "<meta name='viewport' content='width=device-width, initial-scale=1'>\n<meta name='generator' "
      "content='Waymark'>\n<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n<header><h1>{0}</"
      "h1><p>{2}</p>"
      "</header>\n<main>\n",
      escape_markup(report.title), kPageStyle, escape_markup(report.frame), kContentPolicy);
  std::string facts;
  for (const auto& [number, of] : report.facts)
    facts += fmt::format("<li><b>{}</b><span>{}</span></li>", escape_markup(number), escape_markup(of));
  if (!facts.empty()) html += "<ul class='facts'>" + facts + "</ul>\n";
  html += list_of(report.messages);
  if (const std::string plan = plan_figure(report); !plan.empty()) html += section("Plan", plan);
  if (!report.failures.empty()) html += section("Failed images", failures_table(report));
  if (!report.control.empty()) html += section("Surveyed points", control_table(report));
  if (report.surface) html += section("Heights", surface_figures(*report.surface, report.crs));
  html += section("Images", images_table(report));
  if (!report.lenses.empty()) html += section("Lens", lens_table(report));
  return html +
         "</main>\n<footer>Report of a reconstruction \u00b7 no network needed</footer>\n</body>\n</html>\n";
}

}  // namespace waymark::exporters
