// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <string>
#include "workflows/localization/localize.hpp"
#include "workflows/localization/localize_method.hpp"
namespace waymark::workflows {

/// Localizes while the log is being made: takes its readings one by one. The track is that of localize() for
/// the whole log.
class LiveLocalizer {
 public:
  /// Opens the map and begins. `request` as for localize(), without log, start and outputs; `header`: first
  /// line of the log, with the start. Throws Error{usage} for a method that needs the whole log.
  LiveLocalizer(const LocalizeRequest& request, const std::string& header, const Callbacks& callbacks = {});
  /// Opens the map for a robot that is described by a log without events: car, noise and drift of the
  /// odometry, memory of errors. Begins with restart().
  LiveLocalizer(const LocalizeRequest& request, localization::RobotLog robot,
                const Callbacks& callbacks = {});
  LiveLocalizer(const LiveLocalizer&) = delete;

  /// Begins, or begins again, at a pose in the map frame, as when somebody puts the robot there. Without a
  /// pose the whole map is searched. Throws Error{usage} for a method that cannot do that.
  void restart(const std::optional<localization::PoseEstimate>& start);
  /// Returns a start with the standard deviations of the settings start_sd and start_yaw_sd.
  localization::PoseEstimate start_at(const localization::Pose2& pose) const;
  bool has_begun() const { return replay_ != nullptr; }

  /// Takes lines of the log. Throws Error{input} for lines that cannot be read.
  void take(const std::string& lines);
  /// Takes the events of a log in their order, after converting positions to the map frame. Remarks are sent
  /// as warnings. Only after restart().
  void take(localization::RobotLog readings);

  /// Removes all rows of the track but the last, which bounds memory.
  void forget_rows() { replay_->forget_rows(); }

  const localization::LogReplay& replay() const { return *replay_; }
  const localization::Localizer& localizer() const { return *localizer_; }
  const RobotMap& map() const { return opened_->map; }
  /// Returns whether rows of the track have the height of the terrain.
  bool knows_terrain() const { return static_cast<bool>(ground_); }
  /// Returns the landmarks that are used, for a display; none of a map too large for memory.
  std::vector<localization::MapLandmark> landmarks() const { return all_landmarks(map(), sensor_.get()); }

 private:
  localization::RobotLog read(const std::string& lines) const;
  void open(const LocalizeRequest& request, const Callbacks& callbacks);
  void use_noise_of(const LocalizeRequest& request);

  std::string header_, map_file_;
  Callbacks callbacks_;
  MethodTable methods_;
  LocalizeMethod* method_ = nullptr;
  std::shared_ptr<const SensorProfile> sensor_;
  std::optional<OpenedMap> opened_;
  std::optional<LocalizeSettings> settings_;
  localization::TerrainHeight ground_;
  localization::RobotLog log_;
  std::unique_ptr<LocalizeTask> task_;
  std::unique_ptr<localization::Localizer> localizer_;
  std::unique_ptr<localization::LogReplay> replay_;
};

}  // namespace waymark::workflows
