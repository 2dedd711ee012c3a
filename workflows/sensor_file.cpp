// SPDX-License-Identifier: Apache-2.0
#include "workflows/sensor_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/json_text.hpp"
#include "core/options/file_kind.hpp"
#include "core/options/option_reader.hpp"
#include "core/text_file.hpp"
#include "geodb/map_store.hpp"
#include "workflows/registries.hpp"

namespace waymark::workflows {
namespace {

using SensorJson = nlohmann::ordered_json;

constexpr double kSumTolerance = 0.005;  // of weights with two decimals

void describe_coverage(SensorCoverage& coverage, OptionVisitor& option) {
  option("range", coverage.range,
         {.help = "Range at which landmarks are detected, metres; 0: unknown", .min = 0, .max = 1e6});
  option("view", coverage.view,
         {.help = "Horizontal field of view about the heading, degrees", .min = 0.1, .max = 360});
  option("range_sd", coverage.range_sd,
         {.help = "Standard deviation of a range, metres; 0: none is measured", .min = 0, .max = 1e5});
  option("bearing_sd", coverage.bearing_sd,
         {.help = "Standard deviation of a bearing, degrees", .min = 1e-4, .max = 180});
  option("detection", coverage.detection,
         {.help = "Probability that a landmark in range and sight is detected", .min = 0.001, .max = 0.999});
}

void describe_odds(DetectionOdds& odds, OptionVisitor& option) {
  option("intercept", odds.intercept, {.help = "Log odds at range 0 and a diameter of 1 m"});
  option("per_metre", odds.per_metre, {.help = "Log odds per metre of range"});
  option("per_log_diameter", odds.per_log_diameter,
         {.help = "Log odds per natural logarithm of the diameter in metres"});
}

void check_object(const SensorJson& value, const std::string& name, const std::string& source,
                  const std::string& hint) {
  if (!value.is_object())
    throw Error(ErrorCode::usage, fmt::format("\"{}\" is no object", name), source, hint);
}

void check_feature(const LandmarkType& type, const std::string& feature, const std::string& source) {
  std::vector<std::string> names;
  for (const FeatureSpec& spec : type.features) names.push_back(spec.name);
  if (std::ranges::find(names, feature) != names.end()) return;
  const std::string nearest = nearest_name(feature, names);
  throw Error(ErrorCode::usage, fmt::format("{} has no feature '{}'", type.name, feature), source,
              nearest.empty() ? fmt::format("`waymark types {}` lists them", type.name)
                              : fmt::format("did you mean '{}'?", nearest));
}

std::vector<FeatureWeight> read_weights(const SensorJson& weights, const std::string& source) {
  check_object(weights, "weights", source, R"(write {"TYPE": {"FEATURE": 1}})");
  std::vector<FeatureWeight> all;
  for (const auto& [type, features] : weights.items()) {
    check_object(features, "weights." + type, source, R"(write {"FEATURE": 1})");
    const LandmarkType* known = all_types().find(type);  // types of plug-ins are not known here
    std::vector<FeatureWeight> of_type;
    for (const auto& [feature, weight] : features.items()) {
      if (known) check_feature(*known, feature, source);
      of_type.push_back({type, feature, 0});
    }
    const auto describe = [&](OptionVisitor& option) {
      for (FeatureWeight& one : of_type)
        option(one.feature, one.weight, {.help = "weights of a type sum to 1", .min = 0, .max = 1});
    };
    read_and_warn(describe, features.dump(),
                  {.owner = "weights." + type, .prefix = "weights." + type + ".", .where = source}, {});
    double sum = 0;
    for (const FeatureWeight& one : of_type) sum += one.weight;
    all.insert(all.end(), of_type.begin(), of_type.end());
    if (!(std::abs(sum - 1) <= kSumTolerance))
      throw Error(ErrorCode::usage, fmt::format("the weights of {} sum to {:g}, not to 1", type, sum), source,
                  "divide each by that sum (eq. 8)");
  }
  return all;
}

}  // namespace

SensorProfile parse_sensor(std::string_view json, const std::string& name, const std::string& source) {
  check_file_kind(json, "sensor", source);
  const SensorJson file = SensorJson::parse(json_or_empty(json));
  SensorProfile sensor{.name = name, .summary = {}, .weights = {}};
  read_and_warn(
      [&](OptionVisitor& option) {
        option("summary", sensor.summary, {.help = "One line that describes the sensor"});
      },
      json,
      {.owner = "the sensor", .where = source, .also = {"waymark_sensor", "name", "weights", "coverage"}},
      {});
  if (file.contains("weights")) sensor.weights = read_weights(file["weights"], source);
  if (!file.contains("coverage")) return sensor;
  const SensorJson& coverage = file["coverage"];
  check_object(coverage, "coverage", source, R"(write {"range": 25, "view": 270})");
  read_and_warn([&](OptionVisitor& option) { describe_coverage(sensor.coverage, option); }, coverage.dump(),
                {.owner = "the coverage", .prefix = "coverage.", .where = source, .also = {"detection_odds"}},
                {});
  if (coverage.contains("detection_odds")) {
    check_object(coverage["detection_odds"], "coverage.detection_odds", source, R"(write {"intercept": 2})");
    DetectionOdds odds;
    read_and_warn([&](OptionVisitor& option) { describe_odds(odds, option); },
                  coverage["detection_odds"].dump(),
                  {.owner = "the detection", .prefix = "coverage.detection_odds.", .where = source}, {});
    sensor.coverage.detection_odds = odds;
  }
  return sensor;
}

std::string sensor_as_json(const SensorProfile& sensor) {
  const auto rounded = [](double value) { return std::round(value * 1e6) / 1e6; };
  std::map<std::string, double> sums;
  for (const FeatureWeight& feature : sensor.weights) sums[feature.type] += feature.weight;
  SensorJson record{{"waymark_sensor", 1},
                    {"name", sensor.name},
                    {"summary", sensor.summary},
                    {"weights", SensorJson::object()}};
  for (const FeatureWeight& feature : sensor.weights)
    record["weights"][feature.type][feature.feature] =
        rounded(sums[feature.type] > 0 ? feature.weight / sums[feature.type] : 0);
  const SensorCoverage& c = sensor.coverage;
  record["coverage"] = {{"range", c.range},
                        {"view", c.view},
                        {"range_sd", c.range_sd},
                        {"bearing_sd", c.bearing_sd},
                        {"detection", c.detection}};
  if (c.detection_odds)
    record["coverage"]["detection_odds"] = {{"intercept", c.detection_odds->intercept},
                                            {"per_metre", c.detection_odds->per_metre},
                                            {"per_log_diameter", c.detection_odds->per_log_diameter}};
  return record.dump(2);
}

std::shared_ptr<const SensorProfile> find_sensor(const std::string& name_or_file) {
  if (const SensorProfile* sensor = all_sensors().find(name_or_file))
    return std::make_shared<const SensorProfile>(*sensor);
  const std::filesystem::path path(name_or_file);
  if (path.extension() == ".json")
    return std::make_shared<const SensorProfile>(parse_sensor(
        read_text(path, "the sensor file", ErrorCode::usage), path.stem().string(), name_or_file));
  return std::make_shared<const SensorProfile>(all_sensors().at(name_or_file));  // throws the nearest name
}

std::shared_ptr<const SensorProfile> find_sensor(const std::string& name_or_file, const std::string& map) {
  if (name_or_file != "map") return find_sensor(name_or_file);
  const std::vector<geodb::RunRecord> runs = geodb::MapStore::open(map).runs();
  for (auto run = runs.rbegin(); run != runs.rend(); ++run) {
    const SensorJson job = SensorJson::parse(json_or_empty(run->job_json));
    if (!job.is_object() || !job.contains("sensor")) continue;
    const SensorJson& sensor = job["sensor"];
    const bool named = sensor.is_object() && sensor.contains("name") && sensor["name"].is_string();
    const std::string name = named ? sensor["name"].get<std::string>() : "map";
    return std::make_shared<const SensorProfile>(parse_sensor(sensor.dump(), name, map));
  }
  throw Error(ErrorCode::usage, "no run of the map records a sensor", map,
              "pass --sensor NAME or FILE.json; `waymark run --sensor` records one");
}

void record_sensor(std::string& job_json, const SensorProfile& sensor) {
  SensorJson job = SensorJson::parse(json_or_empty(job_json));
  job["sensor"] = SensorJson::parse(json_or_empty(sensor_as_json(sensor)));
  job_json = job.dump();
}

}  // namespace waymark::workflows
