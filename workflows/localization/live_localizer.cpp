// SPDX-License-Identifier: Apache-2.0
#include "workflows/localization/live_localizer.hpp"

#include <fmt/format.h>

#include <sstream>

#include "core/error.hpp"
#include "importers/logs/log_records.hpp"
#include "localization/detectors/detected_types.hpp"
#include "localization/detectors/scan_landmarks.hpp"
#include "workflows/sensor_file.hpp"

namespace waymark::workflows {

LiveLocalizer::LiveLocalizer(const LocalizeRequest& request, const std::string& header,
                             const Callbacks& callbacks)
    : header_(header) {
  register_methods(methods_);
  LocalizeMethod& method = methods_.find(request.method);
  if (!request.sensor.empty()) sensor_ = find_sensor(request.sensor, request.map);
  settings_ = make_settings(request, method, sensor_.get(), callbacks);
  OpenedMap opened = open_robot_map(request.map, sensor_.get(), false, request.min_confidence);
  map_ = opened.map;
  use_survey_accuracy(*map_, settings_->play);
  log_ = read("");
  if (!log_.start)
    throw Error(ErrorCode::input, "the header of the log has no start", request.map, "add \"start\"");
  localization::PoseEstimate start{*log_.start, Eigen::Matrix3d::Zero()};
  const double sd = log_.start_sd > 0 ? log_.start_sd : settings_->start_sd;
  start.covariance = Eigen::Vector3d(sd * sd, sd * sd, log_.start_yaw_sd * log_.start_yaw_sd).asDiagonal();
  task_ = std::make_unique<LocalizeTask>(
      LocalizeTask{.map_file = request.map,
                   .log_file = request.log,
                   .log = log_,
                   .map = std::move(opened),
                   .start = start,
                   .settings = *settings_,
                   .sensor = sensor_.get(),
                   .ground = open_terrain(*map_, request.dem),
                   .stem_type = localization::detected_types(map_->types()).tree,
                   .callbacks = callbacks});
  localizer_ = method.make(*task_);
  if (!localizer_)
    throw Error(
        ErrorCode::usage,
        fmt::format("--method {} needs the whole log, and does not localize while driving", request.method),
        "", "use ekf, ukf or pf");
  replay_ = std::make_unique<localization::LogReplay>(
      log_, *localizer_, settings_->play,
      localization::make_laser_detector(map_->types(), settings_->scans, map_->held_types),
      localization::TimeSource{}, task_->ground);
}

localization::RobotLog LiveLocalizer::read(const std::string& lines) const {
  static const std::filesystem::path name = "log.jsonl";
  std::vector<importers::LogRecord> records{{1, header_}};
  std::istringstream text(lines);
  for (std::string line; std::getline(text, line);)
    if (!line.empty()) records.push_back({records.size() + 1, line});
  localization::RobotLog log = importers::read_log_records(
      name, records, map_->types(), sensor_ ? std::optional(sensor_->coverage) : std::nullopt,
      map_->held_types);
  localization::convert_to_map_frame(log, map_->frame);
  return log;
}

void LiveLocalizer::take(const std::string& lines) {
  const localization::RobotLog log = read(lines);
  for (const localization::LogEvent& event : log.events) replay_->take(event);
}

}  // namespace waymark::workflows
