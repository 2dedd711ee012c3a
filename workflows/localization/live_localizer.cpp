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
  open(request, callbacks);
  log_ = read("");
  if (!log_.start)
    throw Error(ErrorCode::input, "the header of the log has no start", request.map, "add \"start\"");
  use_noise_of(request);
  const double sd = log_.start_sd > 0 ? log_.start_sd : settings_->start_sd;
  localization::PoseEstimate start{*log_.start, Eigen::Matrix3d::Zero()};
  start.covariance = Eigen::Vector3d(sd * sd, sd * sd, log_.start_yaw_sd * log_.start_yaw_sd).asDiagonal();
  restart(start);
}

LiveLocalizer::LiveLocalizer(const LocalizeRequest& request, localization::RobotLog robot,
                             const Callbacks& callbacks) {
  open(request, callbacks);
  log_ = std::move(robot);
  use_noise_of(request);
}

void LiveLocalizer::open(const LocalizeRequest& request, const Callbacks& callbacks) {
  register_methods(methods_);
  method_ = &methods_.find(request.method);
  if (!dynamic_cast<const FilterMethod*>(method_))
    throw Error(
        ErrorCode::usage,
        fmt::format("--method {} needs the whole log, and does not localize while driving", request.method),
        "", "use ekf, ukf or pf");
  map_file_ = request.map;
  callbacks_ = callbacks;
  if (!request.sensor.empty()) sensor_ = find_sensor(request.sensor, request.map);
  settings_ = make_settings(request, *method_, sensor_.get(), callbacks);
  opened_ = open_robot_map(request.map, sensor_.get(), false, request.min_confidence);
  use_survey_accuracy(map(), settings_->play);
  ground_ = open_terrain(map(), request.dem);
}

void LiveLocalizer::use_noise_of(const LocalizeRequest& request) {
  const DescribeOptions options = [&](OptionVisitor& visitor) { method_->describe_all(*settings_, visitor); };
  share_odometry_noise(request, options, settings_->play, log_);
}

localization::PoseEstimate LiveLocalizer::start_at(const localization::Pose2& pose) const {
  const double sd = settings_->start_sd, yaw_sd = settings_->start_yaw_sd;
  return {pose, Eigen::Vector3d(sd * sd, sd * sd, yaw_sd * yaw_sd).asDiagonal()};
}

void LiveLocalizer::restart(const std::optional<localization::PoseEstimate>& start) {
  if (!start && method_->start() == StartPolicy::required)
    throw Error(ErrorCode::usage,
                fmt::format("--method {} must know where the robot starts", method_->name()), map_file_,
                "give the start, or use --method pf");
  replay_.reset();
  localizer_.reset();  // it may refer to the task
  task_ = std::make_unique<LocalizeTask>(
      LocalizeTask{.map_file = map_file_,
                   .log_file = {},
                   .log = log_,
                   .map = *opened_,
                   .start = method_->start() == StartPolicy::ignored ? std::nullopt : start,
                   .settings = *settings_,
                   .sensor = sensor_.get(),
                   .ground = ground_,
                   .stem_type = localization::detected_types(map().types()).tree,
                   .callbacks = callbacks_});
  localizer_ = method_->make(*task_);
  replay_ = std::make_unique<localization::LogReplay>(
      log_, *localizer_, settings_->play,
      localization::make_laser_detector(map().types(), settings_->scans, map().held_types),
      localization::TimeSource{}, ground_);
}

localization::RobotLog LiveLocalizer::read(const std::string& lines) const {
  static const std::filesystem::path name = "log.jsonl";
  std::vector<importers::LogRecord> records{{1, header_}};
  std::istringstream text(lines);
  for (std::string line; std::getline(text, line);)
    if (!line.empty()) records.push_back({records.size() + 1, line});
  localization::RobotLog log = importers::read_log_records(
      name, records, map().types(),
      {.sensor = sensor_ ? std::optional(sensor_->coverage) : std::nullopt, .held_types = map().held_types});
  localization::convert_to_map_frame(log, map().frame);
  return log;
}

void LiveLocalizer::take(const std::string& lines) {
  const localization::RobotLog log = read(lines);
  for (const localization::LogEvent& event : log.events) replay_->take(event);
}

void LiveLocalizer::take(localization::RobotLog readings) {
  localization::convert_to_map_frame(readings, map().frame);
  for (const std::string& remark : readings.remarks) callbacks_.warning(remark);
  for (const localization::LogEvent& event : readings.events) replay_->take(event);
}

}  // namespace waymark::workflows
