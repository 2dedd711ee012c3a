// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/run/run_state.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace waymark::pipeline {
namespace {

/// Collects warnings; equal warnings of several tiles are listed once, with the number of tiles.
class WarningList {
 public:
  void add(const std::string& text, const Unit& unit) {
    const auto known = std::ranges::find(entries_, text, &Entry::text);
    if (known == entries_.end())
      entries_.push_back({text, unit.index() ? unit.item : "", 1});
    else
      ++known->units;
  }
  std::vector<std::string> texts() const {
    std::vector<std::string> texts;
    for (const auto& [text, item, units] : entries_)
      texts.push_back(item.empty() ? text
                      : units == 1 ? fmt::format("{} ({})", text, item)
                                   : fmt::format("{} ({} and {} more)", text, item, units - 1));
    return texts;
  }

 private:
  struct Entry {
    std::string text, item;  ///< first item with this warning; empty for the map
    int units;
  };
  std::vector<Entry> entries_;
};

}  // namespace

StageReport stage_report(const Plan& plan, const std::vector<UnitState>& states, std::size_t stage) {
  using Status = UnitState::Status;
  StageReport report{.stage = {}, .units = 0, .counts = {}, .warnings = {}};
  WarningList warnings;
  for (std::size_t i = plan.begins[stage]; i < plan.begins[stage + 1]; ++i) {
    const UnitState& state = states[i];
    ++report.units;
    report.made += state.status == Status::made;
    report.reused += state.status == Status::reused;
    report.failed += state.status == Status::failed;
    report.skipped += state.status == Status::skipped;
    report.waiting += state.status == Status::waiting;
    report.counts += state.outcome.counts;
    for (const std::string& warning : state.outcome.warnings) warnings.add(warning, plan.units[i]);
  }
  report.warnings = warnings.texts();
  return report;
}

}  // namespace waymark::pipeline
