// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>

namespace waymark::pipeline {
namespace {

using Json = nlohmann::ordered_json;

/// Returns the number of units and how many of them were not computed in this run: "16, 3 reused".
std::string readable_units(const StageReport& stage) {
  std::string text = fmt::format("{}", stage.units);
  const auto mention = [&](std::int64_t n, const char* what) {
    if (n > 0) text += fmt::format(", {} {}", n, what);
  };
  mention(stage.reused, "reused");
  mention(stage.failed, "failed");
  mention(stage.skipped, "skipped");
  mention(stage.waiting, "waiting");
  return text;
}

/// Indents the lines of a message after the first.
std::string indent(std::string text) {
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; ++at) text.insert(at + 1, "    ");
  return text;
}

}  // namespace

int RunReport::exit_code() const {
  const bool wrong_option = std::ranges::find(failures, ErrorCode::usage, &Failure::code) != failures.end();
  return failures.empty() ? 0 : wrong_option ? 2 : 3;
}

bool RunReport::complete() const {
  return std::ranges::all_of(stages, [](const StageReport& s) { return s.made + s.reused == s.units; });
}

std::string report_as_text(const RunReport& report) {
  std::size_t width = 5;
  for (const StageReport& stage : report.stages) width = std::max(width, stage.stage.size());
  std::string text = fmt::format("{:<{}}  {:>10}  {:>10}  {:>10}  {:>8}  units\n", "stage", width, "in",
                                 "out", "rejected", "seconds");
  for (const StageReport& stage : report.stages) {
    text +=
        fmt::format("{:<{}}  {:>10}  {:>10}  {:>10}  {:>8.2f}  {}\n", stage.stage, width, stage.counts.in,
                    stage.counts.out, stage.counts.rejected_total(), stage.seconds, readable_units(stage));
    for (const auto& [reason, n] : stage.counts.rejected) text += fmt::format("    {} {}\n", n, reason);
    for (const std::string& warning : stage.warnings)
      text += fmt::format("    warning: {}\n", indent(warning));
  }
  for (const Failure& failure : report.failures)
    text += fmt::format("failed: {}\n    {}\n", failure.unit, indent(failure.message));
  return text;
}

std::string report_as_json(const RunReport& report) {
  Json stages = Json::array();
  for (const StageReport& s : report.stages) {
    Json rejected = Json::object();
    for (const auto& [reason, n] : s.counts.rejected) rejected[reason] = n;
    stages.push_back({{"stage", s.stage},
                      {"units", s.units},
                      {"made", s.made},
                      {"reused", s.reused},
                      {"failed", s.failed},
                      {"skipped", s.skipped},
                      {"waiting", s.waiting},
                      {"in", s.counts.in},
                      {"out", s.counts.out},
                      {"rejected", std::move(rejected)},
                      {"seconds", s.seconds},
                      {"warnings", s.warnings}});
  }
  Json failures = Json::array();
  for (const Failure& failure : report.failures)
    failures.push_back({{"unit", failure.unit}, {"message", failure.message}});
  return Json{{"stages", std::move(stages)}, {"failures", std::move(failures)}, {"seconds", report.seconds}}
      .dump(2, ' ', false, Json::error_handler_t::replace);
}

std::ostream& operator<<(std::ostream& stream, const RunReport& report) {
  return stream << report_as_text(report);
}

}  // namespace waymark::pipeline
