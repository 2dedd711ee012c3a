// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <string>
#include "workflows/localization/localize.hpp"
#include "workflows/localization/localize_method.hpp"
namespace waymark::workflows {

/// Localizes while the log is being made: takes its lines one by one. The track is that of localize() for the
/// whole log.
class LiveLocalizer {
 public:
  /// `request` as for localize(), without log and outputs; `header`: first line of the log, with the start.
  /// Throws Error{usage} for a method that needs the whole log.
  LiveLocalizer(const LocalizeRequest& request, const std::string& header, const Callbacks& callbacks = {});
  LiveLocalizer(const LiveLocalizer&) = delete;

  /// Takes lines of the log. Throws Error{input} for lines that cannot be read.
  void take(const std::string& lines);

  const localization::LogReplay& replay() const { return *replay_; }
  const localization::Localizer& localizer() const { return *localizer_; }
  const RobotMap& map() const { return *map_; }

 private:
  localization::RobotLog read(const std::string& lines) const;

  std::string header_;
  std::optional<RobotMap> map_;
  MethodTable methods_;
  std::shared_ptr<const SensorProfile> sensor_;
  std::optional<LocalizeSettings> settings_;
  localization::RobotLog log_;
  std::unique_ptr<LocalizeTask> task_;
  std::unique_ptr<localization::Localizer> localizer_;
  std::unique_ptr<localization::LogReplay> replay_;
};

}  // namespace waymark::workflows
