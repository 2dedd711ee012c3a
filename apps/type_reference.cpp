// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/registry_reference.hpp"

namespace waymark::apps {
namespace {

using Json = nlohmann::ordered_json;

std::string word(Scale scale) {
  switch (scale) {
    case Scale::ratio:
      return "ratio";
    case Scale::interval:
      return "interval";
    case Scale::axis:
      return "axis";
    case Scale::direction:
      return "direction";
  }
  return "";
}

std::string word(AttributeSpec::Kind kind) {
  using Kind = AttributeSpec::Kind;
  return kind == Kind::real ? "number" : kind == Kind::integer ? "integer" : "string";
}

std::string range(const FeatureSpec& feature) {
  const std::string unit = feature.unit.empty() ? "" : " " + feature.unit;
  return fmt::format("{} to {}{}", feature.min_value, feature.max_value, unit);
}

std::string evidence_line(const LandmarkType& type) {
  std::string text = fmt::format("Evidence model {}, identification reach {:g} m", to_string(type.evidence),
                                 type.identification_reach);
  if (!type.body.feature.empty())
    text += fmt::format(", body radius {:g} x {}", type.body.radius_per_value, type.body.feature);
  return text + "\n";
}

std::string as_text(const LandmarkType& type) {
  std::string text = fmt::format("{}: {}\n\nFeatures, with the plausible range:\n", type.name, type.summary);
  for (const FeatureSpec& feature : type.features)
    text += fmt::format("  {:<18} {}; {}\n", feature.name, feature.summary, range(feature));
  if (!type.attributes.empty()) text += "\nAttributes:\n";
  for (const AttributeSpec& attribute : type.attributes)
    text += fmt::format("  {:<18} {}{}\n", attribute.name, attribute.summary,
                        attribute.unit.empty() ? "" : ", " + attribute.unit);
  return text + "\n" + evidence_line(type) +
         fmt::format("Drawn as a {} in {}\n", to_string(type.drawn_as), type.colour);
}

std::string as_markdown(const LandmarkType& type) {
  std::string text =
      fmt::format("# {}\n\n{}.\n\n| feature | unit | scale | plausible | meaning |\n|---|---|---|---|---|\n",
                  type.name, type.summary);
  for (const FeatureSpec& feature : type.features)
    text += fmt::format("| `{}` | {} | {} | {} | {} |\n", feature.name, feature.unit, word(feature.scale),
                        range(feature), feature.summary);
  if (!type.attributes.empty()) text += "\n| attribute | unit | kind | meaning |\n|---|---|---|---|\n";
  for (const AttributeSpec& attribute : type.attributes)
    text += fmt::format("| `{}` | {} | {} | {} |\n", attribute.name, attribute.unit, word(attribute.kind),
                        attribute.summary);
  return text + "\n" + evidence_line(type);
}

std::string as_json(const LandmarkType& type) {
  Json object{{"name", type.name},
              {"summary", type.summary},
              {"features", Json::array()},
              {"attributes", Json::array()},
              {"drawn_as", to_string(type.drawn_as)},
              {"colour", type.colour},
              {"evidence", to_string(type.evidence)},
              {"identification_reach", type.identification_reach}};
  if (!type.body.feature.empty())
    object["body"] = {{"feature", type.body.feature}, {"radius_per_value", type.body.radius_per_value}};
  for (const FeatureSpec& feature : type.features) {
    Json entry{{"name", feature.name},
               {"unit", feature.unit},
               {"scale", word(feature.scale)},
               {"summary", feature.summary}};
    if (std::isfinite(feature.min_value)) entry["lowest"] = feature.min_value;
    if (std::isfinite(feature.max_value)) entry["highest"] = feature.max_value;
    object["features"].push_back(entry);
  }
  for (const AttributeSpec& attribute : type.attributes)
    object["attributes"].push_back({{"name", attribute.name},
                                    {"unit", attribute.unit},
                                    {"kind", word(attribute.kind)},
                                    {"summary", attribute.summary}});
  return object.dump(2);
}

/// Of a landmark as `waymark query --format json` prints it; a value that is not known is null.
std::string as_schema(const LandmarkType& type) {
  Json properties{{"type", {{"const", type.name}}}, {"uid", {{"type", "string"}}}};
  for (const char* coordinate : {"x", "y", "z"}) properties[coordinate] = {{"type", "number"}};
  for (const FeatureSpec& feature : type.features) {
    Json entry{{"type", {"number", "null"}}, {"description", feature.summary}};
    if (!feature.unit.empty()) entry["x-unit"] = feature.unit;
    if (std::isfinite(feature.min_value)) entry["minimum"] = feature.min_value;
    if (std::isfinite(feature.max_value)) entry["maximum"] = feature.max_value;
    properties[feature.name] = entry;
  }
  for (const AttributeSpec& attribute : type.attributes) {
    properties[attribute.name] = {{"type", {word(attribute.kind), "null"}},
                                  {"description", attribute.summary}};
    if (!attribute.unit.empty()) properties[attribute.name]["x-unit"] = attribute.unit;
  }
  return Json{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"title", type.name},
              {"description", type.summary},
              {"type", "object"},
              {"properties", properties},
              {"required", {"type", "uid", "x", "y"}}}
      .dump(2);
}

}  // namespace

std::vector<ReferenceEntry> registry_reference(const TypeRegistry& types) {
  std::vector<ReferenceEntry> all;
  for (const LandmarkType& type : types)
    all.push_back(
        {type.name, type.summary, as_text(type), as_json(type), as_schema(type), as_markdown(type)});
  return all;
}

}  // namespace waymark::apps
