// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
#include "core/options/option_table.hpp"
#include "localization/detectors/scan_landmarks.hpp"
#include "localization/filters/kalman.hpp"
#include "localization/filters/multi_hypothesis_filter.hpp"
#include "localization/filters/particle_filter.hpp"
#include "localization/replay_log.hpp"
#include "localization/track.hpp"
#include "workflows/callbacks.hpp"
#include "workflows/localization/robot_map.hpp"
namespace waymark::workflows {

/// Groups of LocalizeSettings that a method reads. All methods read those of the replay, such as the noise of
/// the odometry.
struct SettingGroups {
  bool identification = true;
  bool kalman = true;  ///< of the Kalman filters, and of a sum of Gaussians
  bool particles = true;
  bool unseen = true;  ///< `expect_unseen` and the sensor's view, part of `particles`
  bool scans = true, sight = true;
  bool start = true;  ///< standard deviations of the start

  /// Returns those of a method that matches no sightings: the start alone.
  static SettingGroups without_matching() {
    return {.identification = false,
            .kalman = false,
            .particles = false,
            .unseen = false,
            .scans = false,
            .sight = false};
  }
};

/// Settings that methods share (--set of `waymark localize`).
struct LocalizeSettings {
  localization::IdentificationOptions identification;
  localization::KalmanOptions kalman;
  localization::MultiHypothesisOptions hypotheses;
  localization::ParticleOptions particles;
  localization::ReplayOptions play;
  localization::ScanDetectionOptions scans;
  localization::LineOfSightOptions sight;
  double start_sd = 0.1, start_yaw_sd = 0.05;  ///< m, rad: standard deviations of the start

  void describe(OptionVisitor& option, const SettingGroups& groups = {});
  /// Throws Error{usage} if `distance=paper` cannot apply to all data association of the method, or if
  /// `alpha` is set without eq. 11.
  void check_distance(const std::string& method) const;
};

/// Sets OPTION=VALUE of the settings above or the method's own. Returns a warning if the option is given by
/// its former name. Throws Error{usage} for an unknown option (with the nearest name) or a value out of
/// range.
[[nodiscard]] std::vector<std::string> set_option(const DescribeOptions& describe,
                                                  const std::string& setting);

/// Whether a method needs the robot's start.
enum class StartPolicy {
  required,
  required_or_none,  ///< required, unless it is said to be unknown
  optional,          ///< used if given; otherwise the method finds the robot
  ignored
};

/// Input of a localization method.
struct LocalizeTask {
  std::string map_file, log_file;
  localization::RobotLog& log;  ///< in the map's frame
  OpenedMap map;
  std::optional<localization::PoseEstimate> start;
  const LocalizeSettings& settings;
  const SensorProfile* sensor;            ///< null: the map's confidence is used
  localization::TerrainHeight ground;     ///< empty without a DEM
  std::string command_line = {};          ///< recorded in written maps
  std::string settings_json = {};         ///< all settings, the method's own included; recorded likewise
  std::string write_map = {};             ///< map to write with the updates; empty: none
  bool update_map = false;                ///< change the map itself
  localization::TrackWatcher watch = {};  ///< receives the growing track
  std::optional<TypeId> stem_type = {};   ///< type of the stems found in laser scans, if the map has one
  Callbacks callbacks = {};
  /// Written by the finder of poses at each search.
  std::shared_ptr<std::optional<localization::PoseSearchRecord>> search =
      std::make_shared<std::optional<localization::PoseSearchRecord>>();
};

/// A way to localize: a file of workflows/localization/methods that defines
/// register_method_<name>(MethodTable&).
class LocalizeMethod {
 public:
  virtual ~LocalizeMethod() = default;
  virtual std::string_view name() const = 0;
  virtual std::string_view summary() const = 0;  ///< "ekf: ..." of the help, without the name
  virtual StartPolicy start() const { return StartPolicy::required; }
  /// Returns false if the map may have no landmarks.
  virtual bool requires_map() const { return true; }
  /// Returns true if --update-map and --write-map apply.
  virtual bool updates_map() const { return false; }
  /// Returns the groups of LocalizeSettings that the method reads.
  virtual SettingGroups groups() const { return {}; }
  /// Declares settings beside LocalizeSettings.
  virtual void describe(OptionVisitor&) {}
  /// Declares all settings that the method reads.
  void describe_all(LocalizeSettings& settings, OptionVisitor& option) {
    settings.describe(option, groups());
    describe(option);
  }
  virtual localization::Track run(LocalizeTask& task) = 0;
  /// Returns a localizer that takes readings one by one; null for a method that needs the whole log.
  virtual std::unique_ptr<localization::Localizer> make(LocalizeTask&) const { return nullptr; }
};

/// A method that plays the log to a Localizer.
class FilterMethod : public LocalizeMethod {
 public:
  localization::Track run(LocalizeTask& task) override;
  std::unique_ptr<localization::Localizer> make(LocalizeTask& task) const override = 0;
};

/// Plays the log to a localizer, with landmarks found in its scans, and measures the time of updates.
localization::Track run_localizer(const LocalizeTask& task, localization::Localizer& localizer);

class MethodTable {
 public:
  template <class T>
  void add() {
    methods_.push_back(std::make_unique<T>());
  }
  std::vector<std::string> names() const;
  /// Returns "odometry: ...; ekf: ..." for the help.
  std::string summaries() const;
  /// Throws Error{usage} that lists the methods if there is none of that name.
  LocalizeMethod& find(std::string_view name) const;

 private:
  std::vector<std::unique_ptr<LocalizeMethod>> methods_;
};

/// Sets the accuracy that an imported map states.
void use_survey_accuracy(const RobotMap& map, localization::ReplayOptions& play);

struct LocalizeRequest;

/// Returns the settings of a request, and sets those of the method itself. Throws Error{usage} for unknown
/// ones, and for a distance that cannot apply. Warns of former names, and of settings that only other methods
/// read.
LocalizeSettings make_settings(const LocalizeRequest& request, LocalizeMethod& method,
                               const SensorProfile* sensor, const Callbacks& callbacks);

/// Gives the settings the odometry noise that the log states, and the log what the request sets.
void share_odometry_noise(const LocalizeRequest& request, const DescribeOptions& options,
                          localization::ReplayOptions& play, localization::RobotLog& log);

/// Registers every method of workflows/localization/methods (generated by cmake/Catalogue.cmake).
void register_methods(MethodTable& registry);

}  // namespace waymark::workflows
