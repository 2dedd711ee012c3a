// SPDX-License-Identifier: Apache-2.0
#include "workflows/localization/localize_method.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>

#include "core/error.hpp"
#include "localization/detectors/detected_types.hpp"
#include "localization/detectors/scan_landmarks.hpp"

namespace waymark::workflows {

localization::Track run_localizer(const LocalizeTask& task, localization::Localizer& localizer) {
  const localization::DetectedTypes types = localization::detected_types(task.map.map.types());
  const localization::ScanTypes seen{types.tree, types.rock};
  return localization::replay(
      task.log, localizer, task.settings.play,
      [&](const localization::LaserScan& scan) {
        return localization::sightings_of_scan(scan, seen, task.settings.scans);
      },
      [] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
      },
      task.ground, task.watch);
}

localization::Track FilterMethod::run(LocalizeTask& task) {
  const auto localizer = make(task);
  return run_localizer(task, *localizer);
}

std::vector<std::string> MethodTable::names() const {
  std::vector<std::string> all;
  for (const auto& method : methods_) all.emplace_back(method->name());
  return all;
}

std::string MethodTable::summaries() const {
  std::vector<std::string> all;
  for (const auto& method : methods_) all.push_back(fmt::format("{}: {}", method->name(), method->summary()));
  return fmt::format("{}", fmt::join(all, "; "));
}

LocalizeMethod& MethodTable::find(std::string_view name) const {
  for (const auto& method : methods_)
    if (method->name() == name) return *method;
  throw Error(ErrorCode::usage, fmt::format("localize has no method '{}'", name), "",
              fmt::format("methods: {}", fmt::join(names(), ", ")));
}

}  // namespace waymark::workflows
