// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/run_section.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/json_text.hpp"
#include "exporters/formatting.hpp"

namespace waymark::exporters {
namespace {

using Json = nlohmann::ordered_json;

/// Parses the report of a run; returns an empty object for an unreadable one, as of a foreign program.
Json parsed(const std::string& text) {
  Json json = Json::parse(json_or_empty(text), nullptr, false);
  return json.is_object() ? json : Json::object();
}

std::string text_at(const Json& object, const char* key) {
  return object.contains(key) && object[key].is_string() ? object[key].get<std::string>() : "";
}

double number_at(const Json& object, const char* key) {
  return object.contains(key) && object[key].is_number() ? object[key].get<double>() : 0;
}

Json list_at(const Json& object, const char* key) {
  return object.contains(key) && object[key].is_array() ? object[key] : Json::array();
}

std::string count_at(const Json& object, const char* key) {
  return number_text(number_at(object, key));
}

std::string units_text(const Json& stage) {
  std::string text = count_at(stage, "units");
  for (const char* part : {"reused", "failed", "skipped", "waiting"})
    if (number_at(stage, part) > 0) text += fmt::format("<small>{} {}</small>", count_at(stage, part), part);
  return text;
}

std::string rejected_text(const Json& stage) {
  const Json reasons =
      stage.contains("rejected") && stage["rejected"].is_object() ? stage["rejected"] : Json::object();
  double total = 0;
  std::string lines;
  for (const auto& [reason, count] : reasons.items()) {
    if (!count.is_number()) continue;
    total += count.get<double>();
    lines += fmt::format("<small>{} {}</small>", number_text(count.get<double>()), escape_markup(reason));
  }
  return number_text(total) + lines;
}

std::string size_text(std::uint64_t bytes) {
  const auto size = static_cast<double>(bytes);
  return size >= 1e6   ? number_text(size / 1e6, 1) + "\u00a0MB"
         : size >= 1e3 ? number_text(size / 1e3, 1) + "\u00a0kB"
                       : number_text(size) + "\u00a0bytes";
}

std::string fact(const char* name, const std::string& html) {
  return html.empty() ? "" : fmt::format("<dt>{}</dt><dd>{}</dd>", name, html);
}

std::string inputs_table(const geodb::RunRecord& run) {
  if (run.inputs.empty()) return {};
  std::string rows;
  for (const InputFile& input : run.inputs)
    rows += fmt::format("<tr><td>{}</td><td>{}</td><td><code>{}</code></td></tr>\n",
                        escape_markup(input.path), size_text(input.bytes), escape_markup(input.sha256));
  return "<div class='scroll'><table class='inputs'><caption>Input files</caption><thead><tr><th "
         "scope='col'>File</th>"
         "<th scope='col'>Size</th><th scope='col'>SHA-256</th></tr></thead><tbody>" +
         rows + "</tbody></table></div>\n";
}

std::string code(const std::string& text) {
  return text.empty() ? "" : "<code>" + escape_markup(text) + "</code>";
}

std::string job_details(const geodb::RunRecord& run) {
  const Json job = Json::parse(json_or_empty(run.job_json), nullptr, false);
  if (run.job_json.empty()) return {};
  return fmt::format("<details><summary>Job with every option</summary><pre>{}</pre></details>\n",
                     escape_markup(job.is_discarded() ? run.job_json : job.dump(2)));
}

}  // namespace

std::string stage_table(const geodb::RunRecord& run) {
  const Json stages = list_at(parsed(run.report_json), "stages");
  if (stages.empty()) return {};
  std::string html =
      "<div class='scroll'><table class='stages'><caption>In = out + rejected"
      "</caption><thead><tr><th scope='col'>Stage</th><th scope='col'>In</th><th scope='col'>Out</th>"
      "<th scope='col'>Rejected</th><th scope='col'>Units</th><th "
      "scope='col'>Seconds</th></tr></thead><tbody>\n";
  for (const Json& stage : stages)
    html += fmt::format(
        "<tr><th scope='row'>{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
        escape_markup(title_of(text_at(stage, "stage"))), count_at(stage, "in"), count_at(stage, "out"),
        rejected_text(stage), units_text(stage), number_text(number_at(stage, "seconds"), 2));
  return html + "</tbody></table></div>\n";
}

std::string warning_list(const geodb::RunRecord& run) {
  const Json report = parsed(run.report_json);
  std::string items;
  for (const Json& failure : list_at(report, "failures"))
    items += fmt::format("<li><b>{} failed:</b> {}</li>", escape_markup(text_at(failure, "unit")),
                         escape_markup(text_at(failure, "message")));
  for (const Json& stage : list_at(report, "stages"))
    for (const Json& warning : list_at(stage, "warnings"))
      if (warning.is_string())
        items += fmt::format("<li><b>{}:</b> {}</li>", escape_markup(title_of(text_at(stage, "stage"))),
                             escape_markup(warning.get<std::string>()));
  return items.empty() ? "" : "<ul class='warnings'>" + items + "</ul>\n";
}

std::string provenance(const std::vector<geodb::RunRecord>& runs) {
  if (runs.empty()) return "<p class='empty'>No run is recorded in this map.</p>";
  std::string html;
  for (auto run = runs.rbegin(); run != runs.rend(); ++run) {
    if (runs.size() > 1) html += fmt::format("<h3>Run {} of {}</h3>", runs.rend() - run, runs.size());
    html += "<dl>" + fact("Started", escape_markup(run->started_utc)) +
            fact("Took",
                 run->seconds > 0 ? number_text(run->seconds, run->seconds < 10 ? 2 : 0) + "\u00a0s" : "") +
            fact("Waymark", escape_markup(run->version)) + fact("Command", code(run->command_line)) +
            fact("Random seed", fmt::format("{}", run->seed)) + "</dl>\n" + inputs_table(*run) +
            job_details(*run);
  }
  return html;
}

}  // namespace waymark::exporters
