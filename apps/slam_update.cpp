// SPDX-License-Identifier: Apache-2.0
#include "apps/slam_update.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "apps/log.hpp"
#include "apps/provenance.hpp"
#include "apps/registries.hpp"
#include "core/error.hpp"
#include "core/quality.hpp"
#include "geodb/update_map.hpp"
#include "geodb/write_map.hpp"
#include "importers/hash.hpp"
#include "landmarks/uid.hpp"
#include "localization/detectors/scan_landmarks.hpp"
#include "localization/slam/existence.hpp"

namespace waymark {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Mean and spread of one feature over the looks at a landmark.
FeatureValue feature_of(const SlamLandmark& l, std::size_t i, Scale scale) {
  std::vector<WeightedValue> values;
  for (const KnownFeatures& look : l.looks)
    if (look.known(i)) values.push_back({look.value[i], 1});
  return values.empty() ? FeatureValue{} : merge(values, scale);
}

void learn_features(const SlamLandmark& seen, const LandmarkType& type, Landmark& into) {
  into.features.resize(type.features.size());
  into.quality.of_feature.resize(type.features.size());
  for (std::size_t i = 0; i < std::min(type.features.size(), kMaxFeatures); ++i) {
    if (into.features[i].known()) continue;
    const FeatureSpec& spec = type.features[i];
    const FeatureValue value = feature_of(seen, i, spec.scale);
    if (!value.known() || !(value.value >= spec.lowest && value.value <= spec.highest)) continue;
    into.features[i] = value;
    into.quality.of_feature[i] = spread_confidence(value, spec.scale, spec.reference);
  }
}

void place(const SlamLandmark& seen, const LocalFrame& frame, Landmark& into, bool is_new) {
  const double height = frame.map_frame_from_crs(into.position).xyz.z();
  const double kept = into.position.xyz.z();
  into.position = frame.crs_from_map_frame({{seen.at.x(), seen.at.y(), is_new ? 0 : height}});
  if (!is_new) into.position.xyz.z() = kept;
  into.covariance.topLeftCorner<2, 2>() = seen.covariance;
  if (is_new) into.covariance(2, 2) = kUnknown;
}

Observation evidence_of(const Landmark& l, const SlamLandmark& seen, const std::string& source) {
  Observation o;
  o.type = l.type;
  o.landmark_uid = l.uid;
  o.source = source;
  o.position = l.position;
  o.covariance = l.covariance;
  o.covariance(2, 2) = kUnknown;
  o.confidence = std::clamp(probability_of(seen.log_odds), 1e-3, 1.0);
  o.features.resize(l.features.size());
  for (std::size_t i = 0; i < std::min(o.features.size(), kMaxFeatures); ++i)
    if (seen.features.known(i) && !seen.looks.empty())
      o.features[i] = {seen.features.value[i], seen.features.variance[i], 1};
  return o;
}

void count(const SlamLandmark& seen, Landmark& into) {
  into.confidence = probability_of(seen.log_odds);
  into.quality.seen += static_cast<int>(seen.matches);
  into.quality.visible += static_cast<int>(std::max(seen.expected, seen.matches));
}

RunRecord record_of(const LocalizeTask& task, const SlamUpdate& update, const std::string& job) {
  RunRecord run = record_of_run(task.command_line, std::chrono::system_clock::now());
  run.job_json = job;
  run.report_json = nlohmann::json{
      {"changed", update.changed.size()},
      {"added", update.added.size()},
      {"evidence", update.evidence.size()},
      {"left_out_untyped",
       update.untyped}}.dump();
  for (const std::string& file : {task.map_file, task.log_file})
    if (std::filesystem::is_regular_file(file)) run.inputs.push_back(hash_file(file));
  return run;
}

}  // namespace

SlamRun slam_run(const LocalizeTask& task, const SlamOptions& options) {
  if (!task.start && task.map.map.landmarks > 0)
    throw Error(ErrorCode::usage, "SLAM must know where the robot starts in a map with landmarks",
                task.log_file, "give --start X,Y,YAW (metres and radians), or the map none");
  SlamRun run{.options = options,
              .play = task.settings.play,
              .start = task.start.value_or(PoseEstimate{{}, Eigen::Matrix3d::Identity() * 1e-9})};
  run.options.use_identities = task.settings.identification.use_identities;
  run.options.quality_floor = task.settings.identification.quality_floor;
  return run;
}

Track play_with(const LocalizeTask& task, const SlamRun& run, Localizer& localizer) {
  const TypeRegistry& types = task.map.map.types();
  const auto type = [&](const char* name) {
    return types.find(name) ? std::optional<TypeId>(types.id(name)) : std::nullopt;
  };
  const ScanTypes seen{type("tree"), type("rock")};
  ScanLandmarks scans = task.settings.scans;
  // A map without landmarks has all types and says nothing; the log of a park does. Its beams are so far
  // apart that a stem is one or two wide: diameters only mislead (ATE 1.9 m with, 1.2 m without).
  if (scans.find == "auto" && task.log.odometry) scans = {.find = "stems", .features = false};
  return play(
      task.log, localizer, run.play,
      [&](const LaserScan& scan) { return sightings_of_scan(scan, seen, scans); },
      [] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
      });
}

SlamUpdate slam_update(std::span<const SlamLandmark> landmarks, const RobotMap& map,
                       const LandmarkNames& names, const std::string& source, double confirmed) {
  SlamUpdate update;
  const TypeRegistry& types = map.types();
  std::unordered_map<LandmarkKey, Landmark> of_map;
  for (Landmark& l : map.store->query({})) of_map.emplace(landmark_key(l.uid), std::move(l));
  std::vector<const SlamLandmark*> seen_of;
  std::optional<TypeId> fallback;
  if (types.find("beacon"))
    fallback = types.id("beacon");
  else if (types.size() == 1)
    fallback = TypeId{0};
  for (const SlamLandmark& l : landmarks) {
    if (l.of_map) {
      const auto known = of_map.find(l.key.value_or(0));
      if (known == of_map.end() || l.expected == 0) continue;
      Landmark changed = known->second;
      if (l.matches > 0) {
        place(l, map.frame, changed, false);
        learn_features(l, types[changed.type], changed);
      }
      count(l, changed);
      if (l.matches > 0) update.evidence.push_back(evidence_of(changed, l, source));
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
    place(l, map.frame, added, true);
    learn_features(l, types[added.type], added);
    added.attributes.resize(types[added.type].attributes.size());
    count(l, added);
    added.observations = 1;
    update.added.push_back(std::move(added));
    seen_of.push_back(&l);
  }
  assign_uids(types, map.crs(), update.added);
  for (std::size_t i = 0; i < update.added.size(); ++i) {
    Landmark& added = update.added[i];
    const auto name = names.find(seen_of[i]->key.value_or(0));
    if (seen_of[i]->key && name != names.end()) added.uid = name->second;
    while (of_map.contains(landmark_key(added.uid))) added.uid += "-s";
    update.evidence.push_back(evidence_of(added, *seen_of[i], source));
  }
  return update;
}

void write_back(const LocalizeTask& task, std::span<const SlamLandmark> landmarks, double confirmed,
                const std::string& job) {
  if (task.write_map.empty() && !task.update_map) return;
  const RobotMap& map = task.map.map;
  std::filesystem::path log(task.log_file);
  if (!log.has_filename()) log = log.parent_path();
  const SlamUpdate update = slam_update(landmarks, map, task.log.names, log.filename().string(), confirmed);
  const RunRecord run = record_of(task, update, job);
  const std::filesystem::path result = task.update_map ? task.map_file : task.write_map;
  if (task.map_file == "none") {
    MapContents contents;
    contents.types = map.types();
    contents.landmarks = update.added;
    contents.observations = update.evidence;
    contents.run = run;
    write_map(result, contents);
  } else {
    update_map(task.map_file, result, [&](MapEditor& editor) {
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
    log_warning(fmt::format("{} landmarks are left out of the map: nothing says of what type they are",
                            update.untyped));
  say(fmt::format("{}: {} landmarks changed, {} added\n", result.string(), update.changed.size(),
                  update.added.size()));
}

}  // namespace waymark
