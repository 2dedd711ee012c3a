// SPDX-License-Identifier: Apache-2.0
#include "importers/rules/import_rules.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "core/error.hpp"
#include "core/options/option_table.hpp"
#include "core/units.hpp"
#include "importers/json_value.hpp"
#include "importers/rules/ready_rules.hpp"

namespace waymark::importers {
namespace {

/// Returns the value of the word among `names`.
template <typename Value>
Value choose(const JsonValue& word, const std::vector<std::pair<std::string, Value>>& names) {
  std::vector<std::string> all;
  for (const auto& [name, value] : names) {
    if (word.text() == name) return value;
    all.push_back(name);
  }
  word.refuse(fmt::format("there is no '{}'", word.text()),
              fmt::format("it is one of {}", fmt::join(all, ", ")));
}

std::string expression(const JsonValue& value) {
  return value.is_number() ? fmt::format("{}", value.number()) : value.text();
}

std::vector<std::string> one_or_more(const JsonValue& value) {
  if (!value.is_array()) return {expression(value)};
  std::vector<std::string> all;
  for (std::size_t i = 0; i < value.size(); ++i) all.push_back(expression(value[i]));
  return all;
}

std::map<std::string, std::string> read_expressions(const JsonValue& object) {
  if (!object.is_object()) object.refuse("this is an object", R"({"height": "height_m"})");
  std::map<std::string, std::string> all;
  for (const std::string& target : object.keys()) all[target] = expression(object[target]);
  return all;
}

/// Returns whether a part is the border of an area. A closed line has three vertices or more, and the first
/// again.
bool is_outline(const GeometryPart& part) {
  const auto& v = part.vertices;
  return part.kind == GeometryPart::Kind::outline ||
         (part.kind == GeometryPart::Kind::line && v.size() > 3 && v.front() == v.back());
}

/// Returns the value of a key from 0 to `highest`.
double positive(const JsonValue& rule, const std::string& key, const std::string& unit, double highest) {
  const double number = rule[key].number();
  const std::string fault = range_fault(
      {.name = key, .unit = unit, .value = number, .field = {.help = "", .min = 0, .max = highest}}, number);
  if (!fault.empty()) rule[key].refuse(fault);
  return number;
}

std::vector<TagCondition> read_where(const JsonValue& where) {
  if (!where.is_object()) where.refuse("conditions are an object", R"({"highway": "street_lamp"})");
  std::vector<TagCondition> all;
  for (const std::string& tag : where.keys()) {
    TagCondition condition{.tag = tag, .any_of = {}};
    if (where.has(tag)) condition.any_of = one_or_more(where[tag]);  // null: without the tag
    all.push_back(std::move(condition));
  }
  return all;
}

ImportRule read_rule(const JsonValue& rule, const ImportRule& common) {
  rule.expect_only({"type", "layer", "of", "where", "except", "geometry", "open", "min_turn_deg",
                    "min_length", "max_length", "features", "attributes", "uid", "position_sd",
                    "confidence"});
  ImportRule read = common;
  read.type = rule["type"].text();
  if (rule.has("layer")) read.layers = one_or_more(rule["layer"]);
  if (rule.has("of")) read.of_outlines = choose<bool>(rule["of"], {{"all", false}, {"outlines", true}});
  if (rule.has("where")) read.where = read_where(rule["where"]);
  if (rule.has("except")) read.except = read_where(rule["except"]);
  if (rule.has("geometry"))
    read.shape.shape = choose<ShapeOf>(rule["geometry"], {{"point", ShapeOf::point},
                                                          {"centroid", ShapeOf::centroid},
                                                          {"outline", ShapeOf::outline},
                                                          {"corners", ShapeOf::corners},
                                                          {"ends", ShapeOf::ends},
                                                          {"walls", ShapeOf::walls}});
  if (rule.has("open"))
    read.shape.open = choose<OpenSide>(
        rule["open"],
        {{"outside", OpenSide::outside}, {"inside", OpenSide::inside}, {"both", OpenSide::both}});
  if (rule.has("min_turn_deg"))
    read.shape.min_turn = positive(rule, "min_turn_deg", "deg", 170) * kRadiansPerDegree;
  if (rule.has("min_length")) read.shape.min_length = positive(rule, "min_length", "m", 1e6);
  if (rule.has("max_length")) read.shape.max_length = positive(rule, "max_length", "m", 1e6);
  if (rule.has("features")) read.features = read_expressions(rule["features"]);
  if (rule.has("attributes")) read.attributes = read_expressions(rule["attributes"]);
  if (rule.has("uid")) read.uid = rule["uid"].text();
  if (rule.has("position_sd")) read.position_sd = expression(rule["position_sd"]);
  if (rule.has("confidence")) read.confidence = expression(rule["confidence"]);
  return read;
}

std::string known_names() {
  std::vector<std::string> names;
  for (const auto& [name, rules] : ready_rules()) names.push_back(name);
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

bool ImportRule::matches(const MapElement& element) const {
  if (of_outlines && std::ranges::none_of(element.parts, is_outline)) return false;
  if (!layers.empty() && std::ranges::find(layers, element.layer) == layers.end()) return false;
  const auto holds = [&](const TagCondition& condition) {
    const auto tag = element.tags.find(condition.tag);
    if (condition.any_of.empty()) return tag == element.tags.end();
    return tag != element.tags.end() && std::ranges::any_of(condition.any_of, [&](const std::string& value) {
             return value == "*" || value == tag->second;
           });
  };
  return std::ranges::all_of(where, holds) && std::ranges::none_of(except, holds);
}

MapElement ImportRule::taken(const MapElement& element) const {
  if (!of_outlines) return element;
  MapElement outlines = element;
  std::erase_if(outlines.parts, [](const GeometryPart& part) {
    return part.kind != GeometryPart::Kind::hole && !is_outline(part);
  });
  for (GeometryPart& part : outlines.parts)
    if (part.kind == GeometryPart::Kind::line) {
      part.kind = GeometryPart::Kind::outline;
      part.vertices.pop_back();
    }
  return outlines;
}

std::string ImportRule::title() const {
  std::vector<std::string> conditions;
  for (const TagCondition& c : where)
    conditions.push_back(c.any_of.empty() ? "no " + c.tag
                                          : fmt::format("{} = {}", c.tag, fmt::join(c.any_of, "|")));
  if (!layers.empty()) conditions.push_back(fmt::format("layer {}", fmt::join(layers, "|")));
  return conditions.empty() ? type : fmt::format("{} ({})", type, fmt::join(conditions, ", "));
}

std::string import_rules_text(const std::string& file_or_name) {
  const auto ready = ready_rules().find(file_or_name);
  return ready == ready_rules().end() ? read_vsi_text(file_or_name) : ready->second.json;
}

ImportRules read_import_rules(const std::string& file_or_name) {
  const bool is_name = file_or_name.find_first_of("./\\") == std::string::npos;
  const auto ready = ready_rules().find(file_or_name);
  if (is_name && ready == ready_rules().end() && !std::filesystem::exists(file_or_name))
    throw Error(ErrorCode::usage, fmt::format("there are no ready rules '{}'", file_or_name), "--rules",
                fmt::format("pass a file, or one of {}", known_names()));
  const JsonValue root = ready == ready_rules().end()
                             ? JsonValue::from_file(file_or_name)
                             : JsonValue::from_text(ready->second.json, file_or_name);
  if (!root.is_object() || !root.has("waymark_rules"))
    root.refuse("this is no rules file", R"(it begins with {"waymark_rules": 1})");
  root.expect_only(
      {"waymark_rules", "crs", "map_crs", "layer", "unit", "position_sd", "confidence", "rules"});
  if (root["waymark_rules"].integer() != 1)
    root["waymark_rules"].refuse("this version of rules files is not known", "write 1");
  ImportRules read;
  if (root.has("crs")) read.crs = root["crs"].text();
  if (root.has("map_crs")) read.map_crs = root["map_crs"].text();
  if (root.has("layer")) read.layer = root["layer"].text();
  if (root.has("unit")) read.unit = root["unit"].text();
  ImportRule common;
  if (root.has("position_sd")) common.position_sd = expression(root["position_sd"]);
  if (root.has("confidence")) common.confidence = expression(root["confidence"]);
  const JsonValue rules = root["rules"];
  if (!rules.is_array() || rules.size() == 0)
    rules.refuse("rules are a list of at least one", R"([{"type": "tree", "where": {"natural": "tree"}}])");
  for (std::size_t i = 0; i < rules.size(); ++i) read.rules.push_back(read_rule(rules[i], common));
  return read;
}

}  // namespace waymark::importers
