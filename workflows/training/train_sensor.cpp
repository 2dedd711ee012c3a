// SPDX-License-Identifier: Apache-2.0
#include "workflows/training/train_sensor.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <utility>
#include <variant>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "importers/logs/import_log.hpp"
#include "localization/detectors/scan_landmarks.hpp"
#include "localization/robot_log.hpp"
#include "localization/sensor_fit.hpp"
#include "workflows/localization/robot_map.hpp"
#include "workflows/sensor_file.hpp"

namespace waymark::workflows {
namespace {

constexpr double kMinConfidence = 0.5;

void check(const SensorFitRequest& request) {
  if (request.logs.empty())
    throw Error(ErrorCode::usage, "no log is named", "train sensor", "name logs with true poses");
  if (request.map.empty())
    throw Error(ErrorCode::usage, "no map is named", "train sensor", "pass --map MAP.gpkg of the same site");
  if (!request.output.empty() && std::filesystem::path(request.output).extension() != ".json")
    throw Error(ErrorCode::usage, "a sensor file is written as .json", request.output, "e.g. -o mine.json");
}

void append_sightings(const std::string& file, const RobotMap& map,
                      std::vector<localization::SightingsAtTruth>& sets) {
  localization::RobotLog log = importers::import_log(file, map.types(), {.held_types = map.held_types});
  localization::convert_to_map_frame(log, map.frame);
  if (log.truth.empty())
    throw Error(ErrorCode::input, "the log has no true poses", file, "a sensor is fitted to known poses");
  const localization::LaserDetector detect =
      localization::make_laser_detector(map.types(), {}, map.held_types);
  for (const localization::LogEvent& event : log.events) {
    const auto pose = localization::pose_at(log.truth, event.t);
    if (!pose) continue;
    if (const auto* seen = std::get_if<localization::SightingSet>(&event.what))
      sets.push_back({*pose, *seen});
    else if (const auto* scan = std::get_if<localization::LaserScan>(&event.what))
      sets.push_back({*pose, detect(*scan)});
  }
}

std::vector<FeatureWeight> equal_weights(const std::vector<localization::SightingsAtTruth>& sets,
                                         const TypeRegistry& types) {
  std::set<std::pair<TypeId, std::size_t>> measured;
  for (const localization::SightingsAtTruth& set : sets)
    for (const localization::SeenLandmark& s : set.seen.sightings)
      for (const TypeId type : localization::types_of(s)) {
        if (type >= types.size()) continue;
        for (std::size_t i = 0; i < std::min(types[type].features.size(), localization::kMaxFeatures); ++i)
          if (s.features_as(type)->known(i)) measured.emplace(type, i);
      }
  std::vector<FeatureWeight> weights;
  for (const auto& [type, feature] : measured)
    weights.push_back({types[type].name, types[type].features[feature].name, 1});
  return weights;
}

}  // namespace

SensorProfile train_sensor(const SensorFitRequest& request, const Callbacks& callbacks) {
  check(request);
  const OpenedMap opened = open_robot_map(request.map, nullptr, false, kMinConfidence);
  const localization::LandmarkGrid grid(all_landmarks(opened.map, nullptr));
  std::vector<localization::SightingsAtTruth> sets;
  for (const std::string& log : request.logs) append_sightings(log, opened.map, sets);
  const localization::SensorFit fit = localization::fit_sensor(sets, grid);
  const SensorCoverage& c = fit.coverage;
  const std::string summary =
      fmt::format("Fitted to {} sightings of {} logs", fit.matched, request.logs.size());
  const std::string name = std::filesystem::path(request.output).stem().string();
  SensorProfile sensor{.name = name.empty() ? "fitted" : name,
                       .summary = summary,
                       .weights = equal_weights(sets, opened.map.types()),
                       .coverage = c};
  if (!request.output.empty()) write_file(request.output, sensor_as_json(sensor) + "\n");
  callbacks.summary(fmt::format(
      "{}: range {:.3g} m, view {:.3g} deg, sd {:.3g} m and {:.3g} deg, {:.0f} % of {} expected detected\n",
      summary, c.range, c.view, c.range_sd, c.bearing_sd, 100 * c.detection, fit.expected));
  return sensor;
}

}  // namespace waymark::workflows
