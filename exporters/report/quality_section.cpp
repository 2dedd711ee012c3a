// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/quality_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/landmark.hpp"
#include "exporters/formatting.hpp"
#include "exporters/vector/export_columns.hpp"
#include "geodb/map_store.hpp"

namespace waymark::exporters {
namespace {

constexpr double kSide = 260;  // of a calibration plot, drawing units

std::string observed_row(const LandmarkSection& section) {
  const ObservationMeans& means = section.observed;
  std::string row = fmt::format(
      "<tr><th scope='row'>{}</th><td>{}</td><td>{}</td>", escape_markup(title_of(section.type.name)),
      number_text(static_cast<double>(section.count)), number_text(static_cast<double>(means.several)));
  for (const Mean* mean :
       {&means.seen, &means.visible, &means.multiplicity, &means.spread, &means.quality, &means.confidence})
    row += "<td>" + (mean->value() ? number_text(*mean->value(), 2) : "\u2013") + "</td>";
  return row + "</tr>\n";
}

std::string observed_table(const std::vector<LandmarkSection>& sections) {
  std::string rows;
  for (const LandmarkSection& section : sections)
    if (section.count > 0) rows += observed_row(section);
  return "<div class='scroll'><table class='stages'><caption>How well the landmarks were observed: means "
         "over the "
         "landmarks</caption><thead><tr><th scope='col'>Type</th><th scope='col'>Landmarks</th>"
         "<th scope='col' title='In more than one image'>Seen again</th>"
         "<th scope='col' title='Images that show it'>Seen</th>"
         "<th scope='col' title='Images that could have shown it'>Visible</th>"
         "<th scope='col' title='Seen / visible (eq. 5)'>q<sub>#</sub></th>"
         "<th scope='col' title='Agreement of the observed features (eqs. 6, 7)'>q<sub>f</sub></th>"
         "<th scope='col' title='Landmark quality, equal weights (eq. 8), of those that were assessed: not "
         "seen once of once'>Quality</th>"
         "<th scope='col' title='Probability that it exists'>Confidence</th></tr></thead><tbody>\n" +
         rows + "</tbody></table></div>\n";
}

std::string rejection_table(const geodb::MapStore& map) {
  std::map<std::pair<std::string, std::string>, std::int64_t> counts;
  std::map<std::string, std::int64_t> used;
  map.visit_observations([&](Observation&& one) {
    const std::string& type = map.types()[one.type].name;
    one.rejected.empty() ? ++used[type] : ++counts[{type, one.rejected}];
  });
  if (counts.empty()) return {};
  std::string rows;
  for (const auto& [what, count] : counts)
    rows += fmt::format("<tr><th scope='row'>{}</th><th scope='row'>{}</th><td>{}</td></tr>\n",
                        escape_markup(title_of(what.first)), escape_markup(what.second),
                        number_text(static_cast<double>(count)));
  std::string total;
  for (const auto& [type, count] : used)
    total += fmt::format("{}{} of {} were used", total.empty() ? "" : ", ",
                         number_text(static_cast<double>(count)), escape_markup(type));
  return fmt::format(
      "<div class='scroll'><table class='stages inputs'><caption>Observations that were "
      "rejected{}{}</caption>"
      "<thead><tr><th scope='col'>Type</th><th scope='col'>Reason</th><th scope='col'>Observations</th></tr>"
      "</thead><tbody>\n{}</tbody></table></div>\n",
      total.empty() ? "" : "; ", total, rows);
}

std::string calibration_figure(const QualityCheck& check, const std::string& colour) {
  std::string points, bars;
  int found = 0;
  for (const ReliabilityBin& bin : check.bins) {
    if (bin.found == 0) continue;
    found += bin.found;
    const double share = static_cast<double>(bin.right) / bin.found;
    const double sd = std::sqrt(std::max(share * (1 - share), 0.25 / bin.found) / bin.found);
    const double x = kSide * bin.mean, y = kSide * (1 - share);
    bars += fmt::format("M{:.1f} {:.1f}V{:.1f}", x, std::max(0.0, y - kSide * sd),
                        std::min(kSide, y + kSide * sd));
    points += fmt::format(
        "<circle cx='{:.1f}' cy='{:.1f}' r='{:.1f}'><title>{} landmarks claim {:.2f}, {:.2f} are right"
        "</title></circle>",
        x, y, std::clamp(1.2 * std::log2(1.0 + bin.found), 2.5, 9.0), bin.found, bin.mean, share);
  }
  if (found == 0) return {};
  std::string axis;
  for (const double at : {0.0, 0.25, 0.5, 0.75, 1.0})
    axis += fmt::format(
        "<text x='{0:.0f}' y='{1}' text-anchor='middle'>{2:g}</text><text x='-8' y='{3:.0f}' "
        "text-anchor='end'>{2:g}</text>",
        kSide * at, kSide + 18, at, kSide * (1 - at) + 4);
  return fmt::format(
      "<figure class='histogram plot' style='--type:{0}'><figcaption><b>{1}: {2} and truth</b> {3} "
      "landmarks; "
      "they are off by {4:.3f} on average</figcaption><svg viewBox='-48 -12 {5} {6}' role='img' "
      "aria-label='Calibration of {2}'><path class='median' d='M0 {7}L{7} 0'/><g class='axis'><path d='M0 "
      "0V{7}H{7}'/>{8}<text x='{9}' y='{10}' text-anchor='middle'>{11} claimed</text><text "
      "transform='translate(-36 "
      "{9}) rotate(-90)' text-anchor='middle'>fraction that is correct</text></g><g class='points'><path "
      "class='deviation' d='{12}'/>{13}</g></svg></figure>\n",
      escape_markup(colour), escape_markup(title_of(check.type)), escape_markup(check.claim),
      number_text(found), check.expected_error, kSide + 66, kSide + 56, kSide, axis, kSide / 2, kSide + 38,
      escape_markup(title_of(check.claim)), bars, points);
}

std::string calibration_figures(const std::vector<LandmarkSection>& sections,
                                const std::vector<QualityCheck>& checks) {
  std::string figures;
  for (const QualityCheck& check : checks) {
    const auto section =
        std::ranges::find_if(sections, [&](const LandmarkSection& s) { return s.type.name == check.type; });
    figures += calibration_figure(check, section != sections.end() ? section->type.colour : "#666666");
  }
  if (figures.empty()) return {};
  return "<h3>Claimed and true</h3><p>Landmarks grouped by what they claim; on the dashed line they claim "
         "what "
         "is right. Larger dots are more landmarks, bars one standard deviation.</p><div class='histograms "
         "plots'>" +
         figures + "</div>\n";
}

}  // namespace

std::string quality_section(const geodb::MapStore& map, const std::vector<LandmarkSection>& sections,
                            const std::vector<QualityCheck>& checks) {
  const std::string curves = calibration_figures(sections, checks);
  const bool by_images = !map.images().empty() && map.count() > 0;
  const std::string rejected = rejection_table(map);
  if (!by_images && curves.empty() && rejected.empty()) return {};
  return "<section><h2>Quality</h2>" + (by_images ? observed_table(sections) : "") + curves + rejected +
         "</section>\n";
}

}  // namespace waymark::exporters
