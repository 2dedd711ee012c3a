// SPDX-License-Identifier: Apache-2.0
#include "workflows/localization/localize_method.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/options/option_reader.hpp"
#include "localization/detectors/scan_landmarks.hpp"
#include "workflows/localization/localize.hpp"

namespace waymark::workflows {
namespace {

/// Expects landmarks, and looks for those seen without range, where the sensor detects them. Without a known
/// range the settings stay.
void set_coverage(const SensorCoverage& coverage, LocalizeSettings& settings) {
  if (!(coverage.range > 0)) return;
  if (!(coverage.range_sd > 0)) settings.identification.sensor_range = coverage.range;
  localization::WeightOptions& weight = settings.particles.weight;
  weight.view_range = coverage.range;
  weight.view_angle = std::min(coverage.view / 360, 1.0) * 2 * std::numbers::pi;
  weight.detection = coverage.detection;
}

bool has_option(const DescribeOptions& options, const std::string& setting) {
  const std::string name = setting.substr(0, setting.find('='));
  return std::ranges::any_of(option_table(options), [&](const OptionRow& row) {
    return row.name == name || (!name.empty() && row.field.formerly == name);
  });
}

/// Returns the methods that read a setting. Throws Error{usage} if its value is out of range.
std::vector<std::string> methods_with(const std::string& setting) {
  MethodTable methods;
  register_methods(methods);
  std::vector<std::string> found;
  for (const std::string& name : methods.names()) {
    LocalizeMethod& method = methods.find(name);
    LocalizeSettings settings;
    const DescribeOptions options = [&](OptionVisitor& visitor) { method.describe_all(settings, visitor); };
    if (!has_option(options, setting)) continue;
    static_cast<void>(set_option(options, setting));
    found.push_back(name);
  }
  return found;
}

bool is_of_other_method(const std::string& setting) {
  return !methods_with(setting).empty();
}

std::string unused_warning(const std::string& setting, std::string_view method) {
  return fmt::format("--set {} has no effect: --method {} does not read it, but {}", setting, method,
                     fmt::join(methods_with(setting), ", "));
}

}  // namespace

void LocalizeSettings::describe(OptionVisitor& option, const SettingGroups& groups) {
  if (groups.identification) identification.describe(option);
  if (groups.kalman) {
    kalman.describe(option);
    hypotheses.describe(option);
  }
  if (groups.particles)
    particles.describe(option);
  else if (groups.unseen)
    particles.weight.describe_unseen(option);
  play.describe(option);
  if (groups.scans) scans.describe(option);
  if (groups.sight) sight.describe(option);
  if (!groups.start) return;
  option("start_sd", start_sd, {.help = "Metres by which the start may be off", .min = 1e-6, .max = 1e6});
  option("start_yaw_sd", start_yaw_sd,
         {.help = "Radians by which the heading of the start may be off", .min = 1e-6, .max = 4});
}

void LocalizeSettings::check_distance(const std::string& method) const {
  const bool is_particles = method == "pf" || method == "global";
  const auto refuse = [](const std::string& what, const std::string& setting, const std::string& advice) {
    throw Error(ErrorCode::usage, what, "--set " + setting, advice);
  };
  if (identification.distance != "paper") {
    const bool weighs = is_particles && particles.weight.weights == "paper";
    if (!identification.alpha.empty() && !weighs)
      refuse("alpha_f belongs to eq. 11, which this run does not use", "alpha=" + identification.alpha,
             is_particles ? "add --set weights=paper" : "add --set distance=paper");
    return;
  }
  const std::string setting = "distance=paper";
  if (!identification.distance_applies())
    refuse(
        fmt::format("association={} decides by its own evidence, not by eq. 11", identification.association),
        setting, "set association=nearest, greedy or hungarian");
  if (method == "slam" || method == "graph")
    refuse(fmt::format("--method {} has a data association of its own, without eq. 11", method), setting,
           "use --method ekf, ukf, pf or global");
  if (method == "odometry" || method == "beacons")
    refuse(fmt::format("--method {} associates nothing by features", method), setting,
           "use --method ekf, ukf, pf or global");
  if (is_particles && particles.weight.weights != "paper")
    refuse(fmt::format("weights={} has a distance of its own, not eq. 11", particles.weight.weights), setting,
           "add --set weights=paper");
}

std::vector<std::string> set_option(const DescribeOptions& describe, const std::string& setting) {
  const std::size_t equals = setting.find('=');
  if (equals == 0 || equals == std::string::npos)
    throw Error(ErrorCode::usage, "--set takes OPTION=VALUE, is '" + setting + "'", "",
                "e.g. --set particles=1000");
  return set_option(describe, std::string_view(setting).substr(0, equals),
                    std::string_view(setting).substr(equals + 1),
                    {.owner = "localize", .where = "--set " + setting});
}

LocalizeSettings make_settings(const LocalizeRequest& request, LocalizeMethod& method,
                               const SensorProfile* sensor, const Callbacks& callbacks) {
  LocalizeSettings settings;
  if (sensor) set_coverage(sensor->coverage, settings);
  settings.particles.seed = request.seed;
  const DescribeOptions all = [&](OptionVisitor& visitor) {
    settings.describe(visitor);
    method.describe(visitor);
  };
  const DescribeOptions used = [&](OptionVisitor& visitor) { method.describe_all(settings, visitor); };
  for (const std::string& setting : request.set)
    if (has_option(all, setting) || !is_of_other_method(setting))
      for (const std::string& warning : set_option(all, setting)) callbacks.warning(warning);
  settings.check_distance(request.method);
  for (const std::string& setting : request.set)
    if (!has_option(used, setting)) callbacks.warning(unused_warning(setting, method.name()));
  settings.identification.use_identities = request.use_identities;
  settings.particles.threads = request.threads;
  return settings;
}

void share_odometry_noise(const LocalizeRequest& request, const DescribeOptions& options,
                          localization::ReplayOptions& play, localization::RobotLog& log) {
  if (log.odometry) play.odometry = *log.odometry;
  play.drift = log.drift;
  for (const std::string& setting : request.set)
    if (has_option(options, setting)) static_cast<void>(set_option(options, setting));
  log.odometry = play.odometry, log.drift = play.drift;
}

void use_survey_accuracy(const RobotMap& map, localization::ReplayOptions& play) {
  play.frames.survey_sd = map.survey_sd;
}

localization::Track run_localizer(const LocalizeTask& task, localization::Localizer& localizer) {
  // A search of the finder has the time of the row that it is part of.
  const auto watch = [&task](const localization::Track& track) {
    if (*task.search && (*task.search)->t && std::isnan(*(*task.search)->t))
      (*task.search)->t = track.rows.back().t;
    if (task.watch) task.watch(track);
  };
  localization::Track track = localization::replay(
      task.log, localizer, task.settings.play,
      localization::make_laser_detector(task.map.map.types(), task.settings.scans, task.map.map.held_types),
      [] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
      },
      task.ground, watch);
  track.search = *task.search;
  return track;
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
