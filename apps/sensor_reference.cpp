// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/registry_reference.hpp"
#include "workflows/sensor_file.hpp"

namespace waymark::apps {
namespace {

using Json = nlohmann::ordered_json;

std::string coverage_text(const SensorCoverage& coverage) {
  if (!(coverage.range > 0)) return "Range: unknown";
  return fmt::format("Range {:g} m, view {:g} deg, sd {} and {:g} deg, probability of detection {:g}",
                     coverage.range, coverage.view,
                     coverage.range_sd > 0 ? fmt::format("{:g} m", coverage.range_sd) : "no range",
                     coverage.bearing_sd, coverage.detection);
}

std::string as_text(const SensorProfile& sensor) {
  std::string text = fmt::format(
      "{}: {}\n\nWeight of a feature in the quality of a landmark (types not listed: all alike):\n",
      sensor.name, sensor.summary);
  for (const FeatureWeight& feature : sensor.weights)
    text += fmt::format("  {:<14} {:<18} {:g}\n", feature.type, feature.feature, feature.weight);
  return text + "\n" + coverage_text(sensor.coverage) + "\n";
}

std::string as_markdown(const SensorProfile& sensor) {
  std::string text =
      fmt::format("# {}\n\n{}.\n\n| type | feature | weight |\n|---|---|---|\n", sensor.name, sensor.summary);
  for (const FeatureWeight& feature : sensor.weights)
    text += fmt::format("| {} | `{}` | {:g} |\n", feature.type, feature.feature, feature.weight);
  return text + "\n" + coverage_text(sensor.coverage) + ".\n";
}

/// Of the object `weights` above: every feature a sensor can weigh, with this sensor's weight as the default.
std::string as_schema(const SensorProfile& sensor, const TypeRegistry& types) {
  Json properties = Json::object();
  for (const LandmarkType& type : types) {
    Json features = Json::object();
    const std::vector<double> weights = weights_for(sensor, type);
    for (std::size_t i = 0; i < weights.size(); ++i)
      features[type.features[i].name] = {{"type", "number"}, {"minimum", 0}, {"default", weights[i]}};
    properties[type.name] = {{"type", "object"}, {"properties", features}, {"additionalProperties", false}};
  }
  return Json{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"title", sensor.name},
              {"description", sensor.summary},
              {"type", "object"},
              {"properties", properties}}
      .dump(2);
}

}  // namespace

std::vector<ReferenceEntry> registry_reference(const SensorRegistry& sensors, const TypeRegistry& types) {
  std::vector<ReferenceEntry> all;
  for (const SensorProfile& sensor : sensors)
    all.push_back({sensor.name, sensor.summary, as_text(sensor), workflows::sensor_as_json(sensor),
                   as_schema(sensor, types), as_markdown(sensor)});
  return all;
}

}  // namespace waymark::apps
