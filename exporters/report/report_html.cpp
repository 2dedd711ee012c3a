// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/report_html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/atomic_file.hpp"
#include "exporters/formatting.hpp"
#include "exporters/report/histogram.hpp"
#include "exporters/report/image_section.hpp"
#include "exporters/report/landmark_section.hpp"
#include "exporters/report/landmark_table.hpp"
#include "exporters/report/map_drawing.hpp"
#include "exporters/report/map_markers.hpp"
#include "exporters/report/page_style.hpp"
#include "exporters/report/quality_section.hpp"
#include "exporters/report/run_section.hpp"
#include "exporters/report/script_policy.hpp"
#include "exporters/report/size_frequency.hpp"
#include "geodb/map_store.hpp"
#include "geodb/validate_map.hpp"

namespace waymark::exporters {
namespace {

std::string fact(const std::string& number, const std::string& of) {
  return fmt::format("<li><b>{}</b><span>{}</span></li>", escape_markup(number), escape_markup(of));
}

constexpr int kFactsPerType = 3;

/// Returns the key figures of the map.
std::string facts(const std::vector<LandmarkSection>& sections, const std::vector<geodb::RunRecord>& runs) {
  std::string items;
  for (const LandmarkSection& section : sections) {
    if (section.count == 0) continue;
    const std::string type = title_of(section.type.name);
    const std::string whose = sections.size() > 1 ? section.type.name + " " : "";
    items += fact(number_text(static_cast<double>(section.count)), type + " landmarks");
    int shown = 0;
    for (std::size_t i = 0; i < section.type.features.size() && shown < kFactsPerType; ++i) {
      const std::vector<double>& values = section.values[i];
      const FeatureSpec& feature = section.type.features[i];
      if (values.empty() || is_angle(feature.scale)) continue;
      const double largest = *std::max_element(values.begin(), values.end());
      items +=
          fact(number_format(feature, largest)(largest), "largest " + readable_name(whose + feature.name));
      ++shown;
    }
  }
  if (!runs.empty() && runs.back().seconds > 0)
    items += fact(seconds_text(runs.back().seconds), "to make it");
  return items.empty() ? "" : "<ul class='facts'>" + items + "</ul>\n";
}

std::string place_of(const Crs& crs) {
  if (crs.kind() == CrsKind::local) return "Local metres";
  const std::string code = crs.authority().empty() ? "" : " (" + crs.id() + ")";
  return crs.body().name + " \u00b7 " + crs.name() + code;
}

bool counts_craters(const std::vector<LandmarkSection>& sections) {
  return std::ranges::any_of(sections, [](const LandmarkSection& section) {
    return section.type.evidence == EvidenceModel::bowl && section.count > 0;
  });
}

std::string section_html(const LandmarkSection& section, const Crs& crs,
                         const std::optional<CountingArea>& area, std::int64_t top) {
  if (section.count == 0) return {};
  return fmt::format("<section><h2>{}{}</h2><p>{}</p>\n{}{}{}</section>\n", svg_symbol(section.type, 20),
                     escape_markup(title_of(section.type.name)), escape_markup(section.type.summary),
                     histogram_figures(section), size_frequency_figures(section, area),
                     landmark_table(section, crs, top));
}

std::string page(const geodb::MapStore& map, const std::string& title, const ReportOptions& options) {
  const auto sections =
      landmark_sections(map, static_cast<std::size_t>(std::max<std::int64_t>(0, options.top)));
  const auto runs = map.runs();
  const geodb::RunRecord latest = runs.empty() ? geodb::RunRecord{} : runs.back();
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang='en'>\n<head>\n<meta charset='utf-8'>\n{3}\n"
      "<meta name='viewport' content='width=device-width, initial-scale=1'>\n<meta name='generator' "
      "content='Waymark'>\n"
      "<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n<header><h1>{0}</h1><p>{2}</p></"
      "header>\n<main>\n",
      escape_markup(title), kPageStyle, escape_markup(place_of(map.crs())),
      options.interactive ? script_policy(kReportScript) : std::string(kContentPolicy));
  html += facts(sections, runs) + warning_list(latest) + map_figure(map, sections, options.relief_pixels);
  const auto area = counts_craters(sections) ? counting_area(map) : std::nullopt;
  for (const LandmarkSection& section : sections) html += section_html(section, map.crs(), area, options.top);
  html += quality_section(map, sections, options.checks);
  if (const std::string images = image_figures(map, options.images); !images.empty())
    html += "<section><h2>Images</h2>" + images + "</section>\n";
  if (const std::string stages = stage_table(latest); !stages.empty())
    html += "<section><h2>What the run did</h2>" + stages + "</section>\n";
  html += "<section><h2>Where it comes from</h2>" + provenance(runs) +
          fmt::format(
              "<details><summary>Coordinate reference system</summary><pre>{}</pre></details></section>\n",
              escape_markup(map.crs().wkt2()));
  const std::string script =
      options.interactive ? fmt::format("<script>{}</script>\n", kReportScript) : std::string();
  return html +
         fmt::format("</main>\n<footer>Report of {} \u00b7 no network needed</footer>\n{}</body>\n</html>\n",
                     escape_markup(map.path().filename().string()), script);
}

}  // namespace

void write_report(const std::filesystem::path& map_path, const std::filesystem::path& html,
                  const ReportOptions& options) {
  geodb::check_before_reading(map_path);
  const geodb::MapStore map = geodb::MapStore::open(map_path);
  const std::string title = options.title.empty() ? title_of(map_path.stem().string()) : options.title;
  write_file(html, page(map, title, options));
}

}  // namespace waymark::exporters
