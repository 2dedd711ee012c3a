// SPDX-License-Identifier: Apache-2.0
#include "workflows/localization/slam_update.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "core/error.hpp"
#include "core/json_text.hpp"
#include "core/landmark.hpp"
#include "core/rotate_axes.hpp"
#include "geo/axes_rotation.hpp"
#include "geodb/update_map.hpp"
#include "geodb/write_map.hpp"
#include "importers/hash.hpp"
#include "landmarks/semantic_map.hpp"
#include "localization/detectors/scan_landmarks.hpp"
#include "localization/slam/existence_log_odds.hpp"
#include "pipeline/fusion/valuation/common_errors.hpp"
#include "workflows/provenance.hpp"
#include "workflows/registries.hpp"
#include "workflows/sensor_file.hpp"

namespace waymark::workflows {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Returns mean and spread of one feature over the observations of a landmark.
FeatureValue merged_feature(const localization::SlamLandmark& l, std::size_t i, Scale scale) {
  std::vector<WeightedValue> values;
  for (const localization::KnownFeatures& look : l.feature_samples)
    if (look.known(i)) values.push_back({look.value[i], 1});
  return values.empty() ? FeatureValue{} : merge(values, scale);
}

/// Returns a feature of the map after one more observation (eq. 3): the mean of a drive, whose sightings
/// repeat the error of one sensor. The spread is that of all observations.
FeatureValue refined_feature(const FeatureValue& of_map, double of_drive, Scale scale) {
  const double n = of_map.observations;
  const WeightedValue both[] = {{of_map.value, n}, {of_drive, 1}};
  FeatureValue refined = merge(both, scale);
  const double a = difference(of_map.value, refined.value, scale);
  const double b = difference(of_drive, refined.value, scale);
  refined.variance = ((n - 1) * of_map.variance + n * a * a + b * b) / n;
  refined.observations = of_map.observations + 1;
  return refined;
}

/// Returns a landmark with covariance and angles along the axes of the map's CRS; its position stays in the
/// map frame.
localization::SlamLandmark along_crs_axes(const localization::SlamLandmark& seen, const LandmarkType& type,
                                          const LocalFrame& frame) {
  localization::SlamLandmark turned = seen;
  const double rotation = grid_rotation(frame, seen.at);
  if (rotation == 0) return turned;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance.topLeftCorner<2, 2>() = seen.covariance;
  turned.covariance = rotate_axes(covariance, rotation).topLeftCorner<2, 2>();
  for (localization::KnownFeatures& look : turned.feature_samples)
    for (std::size_t i = 0; i < std::min(type.features.size(), localization::kMaxFeatures); ++i)
      if (look.known(i) && is_angle(type.features[i].scale))
        look.value[i] = difference(look.value[i], rotation, type.features[i].scale);
  return turned;
}

void add_features(const localization::SlamLandmark& seen, const LandmarkType& type, Landmark& into) {
  into.features.resize(type.features.size());
  into.quality.feature_confidences.resize(type.features.size());
  for (std::size_t i = 0; i < std::min(type.features.size(), localization::kMaxFeatures); ++i) {
    const FeatureSpec& spec = type.features[i];
    const FeatureValue of_drive = merged_feature(seen, i, spec.scale);
    if (!of_drive.known() || !(of_drive.value >= spec.min_value && of_drive.value <= spec.max_value))
      continue;
    FeatureValue& value = into.features[i];
    std::optional<double>& confidence = into.quality.feature_confidences[i];
    const pipeline::VarianceParts parts =
        value.known() ? pipeline::split_variance(value, spec, confidence) : pipeline::VarianceParts{};
    value.variance = parts.spread;
    value = value.known() ? refined_feature(value, of_drive.value, spec.scale) : of_drive;
    confidence = spread_confidence(value, spec.scale, spec.reference);
    if (parts.common > 0) value.variance = value.variance / value.observations + parts.common;
  }
}

void set_position(const localization::SlamLandmark& seen, const LocalFrame& frame, Landmark& into,
                  bool is_new) {
  const double height = frame.map_frame_from_crs(into.position).xyz.z();
  const double kept = into.position.xyz.z();
  into.position = frame.crs_from_map_frame({{seen.at.x(), seen.at.y(), is_new ? 0 : height}});
  if (!is_new) into.position.xyz.z() = kept;
  into.covariance.topLeftCorner<2, 2>() = seen.covariance;
  if (is_new) into.covariance(2, 2) = kUnknown;
}

Observation make_evidence(const Landmark& l, const localization::SlamLandmark& seen, const LandmarkType& type,
                          const std::string& source) {
  Observation o;
  o.type = l.type;
  o.landmark_uid = l.uid;
  o.source = source;
  o.position = l.position;
  o.covariance = l.covariance;
  o.covariance(2, 2) = kUnknown;
  o.confidence = std::clamp(localization::probability_from_log_odds(seen.log_odds), 1e-3, 1.0);
  o.features.resize(l.features.size());
  for (std::size_t i = 0; i < std::min(o.features.size(), localization::kMaxFeatures); ++i)
    if (const FeatureValue mean = merged_feature(seen, i, type.features[i].scale); mean.known())
      o.features[i] = {mean.value, mean.variance, 1};
  return o;
}

/// Counts the drive as one survey, like an image: its hundreds of scans repeat one view, and would drown the
/// images of the map in eq. 5. The scans speak in the confidence.
void add_counts(const localization::SlamLandmark& seen, Landmark& into) {
  into.confidence = localization::probability_from_log_odds(seen.log_odds);
  ++into.quality.visible;
  into.quality.seen += seen.matches > 0 && !seen.gone;
}

geodb::RunRecord run_record(const LocalizeTask& task, const SlamUpdate& update, std::string_view method) {
  geodb::RunRecord run = make_run_record(task.command_line, std::chrono::system_clock::now());
  using Json = nlohmann::ordered_json;
  Json job{{"method", method},
           {"log", task.log_file},
           {"settings", Json::parse(json_or_empty(task.settings_json))}};
  run.job_json = job.dump();
  if (task.sensor) record_sensor(run.job_json, *task.sensor);
  run.report_json = nlohmann::json{
      {"changed", update.changed.size()},
      {"added", update.added.size()},
      {"evidence", update.evidence.size()},
      {"left_out_untyped",
       update.untyped}}.dump();
  for (const std::string& file : {task.map_file, task.log_file})
    if (std::filesystem::is_regular_file(file)) run.inputs.push_back(importers::hash_file(file));
  return run;
}

// Returns the fraction of a scan's returns that fall on straight walls.
double wall_fraction(const localization::LaserScan& scan, const localization::SightingSet& walls) {
  const auto returns = std::ranges::count_if(scan.ranges, [&](float r) {
    return r > 0 && std::isfinite(r) && static_cast<double>(r) < scan.max_range;
  });
  double angle = 0;
  for (const localization::SeenLandmark& wall : walls.sightings)
    if (wall.extent && wall.range)
      angle += std::atan2(wall.extent->to, *wall.range) - std::atan2(wall.extent->from, *wall.range);
  return returns > 0 ? angle / (std::abs(scan.angle_step) * static_cast<double>(returns)) : 0;
}

// Returns whether half of the scans show that much of walls. Slopes and rocks have straight pieces as well:
// the median is 0.14 on made ground of Mars, 0.47 in the Intel lab and 0.7 in made halls.
bool shows_walls(const localization::RobotLog& log, const TypeRegistry& types) {
  constexpr std::size_t kSample = 60;  // scans, spread over the log
  constexpr double kMinFraction = 0.3;
  std::vector<const localization::LaserScan*> scans;
  for (const localization::LogEvent& event : log.events)
    if (const auto* const scan = std::get_if<localization::LaserScan>(&event.what)) scans.push_back(scan);
  const std::size_t step = scans.size() / kSample + 1;
  const localization::LaserDetector detect = localization::make_laser_detector(types, {.find = "wall_lines"});
  std::size_t looked = 0, with_walls = 0;
  for (std::size_t i = 0; i < scans.size(); i += step, ++looked)
    with_walls += wall_fraction(*scans[i], detect(*scans[i])) > kMinFraction;
  return 2 * with_walls > looked;
}

}  // namespace

std::optional<localization::ScanDetectionOptions> scans_of_log(const localization::RobotLog& log,
                                                               const RobotMap& map) {
  // The beams of the park are so far apart that a stem is one or two wide: diameters mislead (ATE 1.9 m with,
  // 1.2 m without).
  if (log.shows_stems) return {{.find = "stems", .features = false}};
  if (map.landmarks > 0) return {};
  return {{.find = shows_walls(log, map.types()) ? "walls,wall_lines" : "rocks"}};
}

SlamSetup slam_setup(const LocalizeTask& task, const localization::SlamOptions& options) {
  if (!task.start && task.map.map.landmarks > 0)
    throw Error(ErrorCode::usage, "SLAM must know where the robot starts in a map with landmarks",
                task.log_file, "give --start X,Y,YAW (metres and radians), or the map none");
  SlamSetup setup{
      .options = options,
      .play = task.settings.play,
      .start = task.start.value_or(localization::PoseEstimate{{}, Eigen::Matrix3d::Identity() * 1e-9})};
  setup.options.identification = task.settings.identification;
  return setup;
}

void leave_out_fixes_without_start(const LocalizeTask& task, localization::ReplayOptions& play) {
  if (task.start || !play.use_fixes) return;
  const auto fixes = std::ranges::count_if(task.log.events, [](const localization::LogEvent& event) {
    return std::holds_alternative<localization::GnssFix>(event.what) ||
           std::holds_alternative<localization::HeadingFix>(event.what);
  });
  if (fixes == 0) return;
  play.use_fixes = false;
  task.callbacks.warning(fmt::format(
      "{} GNSS and compass readings are not used: it is not known where the map that begins here lies; give "
      "--start X,Y,YAW: {}",
      fixes, task.log_file));
}

localization::Track run_slam(const LocalizeTask& task, const SlamSetup& setup,
                             localization::Localizer& localizer) {
  localization::ScanDetectionOptions scans = task.settings.scans;
  if (scans.find == "auto") scans = scans_of_log(task.log, task.map.map).value_or(scans);
  return localization::replay(
      task.log, localizer, setup.play,
      localization::make_laser_detector(task.map.map.types(), scans, task.map.map.held_types), [] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
      });
}

void warn_of_unplaced_ranges(const LocalizeTask& task, std::size_t count) {
  if (count == 0) return;
  task.callbacks.warning(fmt::format(
      "{} ranges without bearing show no known landmark and are left out: SLAM starts none from ranges "
      "alone; give a map of the beacons (waymark import BEACONS.csv -o MAP.gpkg --type beacon): {}",
      count, task.log_file));
}

SlamUpdate make_slam_update(std::span<const localization::SlamLandmark> landmarks, const RobotMap& map,
                            const localization::LandmarkNames& names, const std::string& source,
                            double confirmed) {
  SlamUpdate update;
  const TypeRegistry& types = map.types();
  std::unordered_map<localization::LandmarkKey, Landmark> of_map;
  for (Landmark& l : map.store->query({})) of_map.emplace(localization::landmark_key(l.uid), std::move(l));
  std::vector<localization::SlamLandmark> seen_of;
  std::optional<TypeId> fallback = find_self_identifying_type(types);
  if (!fallback && types.size() == 1) fallback = TypeId{0};
  for (const localization::SlamLandmark& l : landmarks) {
    if (l.was_mapped) {
      const auto known = of_map.find(l.key.value_or(0));
      if (known == of_map.end() || l.expected == 0) continue;
      Landmark changed = known->second;
      add_counts(l, changed);
      if (l.matches > 0) {
        const LandmarkType& type = types[changed.type];
        const localization::SlamLandmark seen = along_crs_axes(l, type, map.frame);
        set_position(seen, map.frame, changed, false);
        add_features(seen, type, changed);
        update.evidence.push_back(make_evidence(changed, seen, type, source));
      }
      update.changed.push_back(std::move(changed));
      continue;
    }
    if (l.log_odds < confirmed) continue;
    const bool typed = l.type && *l.type < types.size();
    if (!typed && !fallback) {
      ++update.untyped;
      continue;
    }
    Landmark added;
    added.type = typed ? *l.type : *fallback;
    localization::SlamLandmark seen = along_crs_axes(l, types[added.type], map.frame);
    set_position(seen, map.frame, added, true);
    add_features(seen, types[added.type], added);
    added.attributes.resize(types[added.type].attributes.size());
    add_counts(l, added);
    added.observations = 1;
    update.added.push_back(std::move(added));
    seen_of.push_back(std::move(seen));
  }
  assign_uids(types, map.crs(), update.added);
  for (std::size_t i = 0; i < update.added.size(); ++i) {
    Landmark& added = update.added[i];
    const auto name = names.find(seen_of[i].key.value_or(0));
    if (seen_of[i].key && name != names.end()) added.uid = name->second;
    while (of_map.contains(localization::landmark_key(added.uid))) added.uid += "-s";
    update.evidence.push_back(make_evidence(added, seen_of[i], types[added.type], source));
  }
  return update;
}

void write_updated_map(const LocalizeTask& task, std::span<const localization::SlamLandmark> landmarks,
                       double confirmed, std::string_view method) {
  if (task.write_map.empty() && !task.update_map) return;
  const RobotMap& map = task.map.map;
  std::filesystem::path log(task.log_file);
  if (!log.has_filename()) log = log.parent_path();
  const SlamUpdate update =
      make_slam_update(landmarks, map, task.log.names, log.filename().string(), confirmed);
  const geodb::RunRecord run = run_record(task, update, method);
  const std::filesystem::path result = task.update_map ? task.map_file : task.write_map;
  if (task.map_file == "none") {
    geodb::MapContents contents;
    contents.types = map.types();
    contents.landmarks = update.added;
    contents.observations = update.evidence;
    contents.run = run;
    geodb::write_map(result, contents);
  } else {
    geodb::update_map(task.map_file, result, [&](geodb::MapEditor& editor) {
      for (const Landmark& l : update.changed) editor.update(l);
      for (Landmark l : update.added) {
        l.observations = 0;  // counted as the evidence comes
        editor.insert(l);
      }
      for (const Observation& o : update.evidence) editor.add_evidence(o);
      editor.add_run(run);
    });
  }
  if (update.untyped)
    task.callbacks.warning(
        fmt::format("{} landmarks are left out of the map: their type is unknown", update.untyped));
  task.callbacks.summary(fmt::format("{}: {} landmarks changed, {} added\n", result.string(),
                                     update.changed.size(), update.added.size()));
}

}  // namespace waymark::workflows
