// SPDX-License-Identifier: Apache-2.0
#include "importers/rules/bound_rule.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.hpp"

namespace waymark::importers {
namespace {

std::optional<RuleExpression> parse(const std::string& text, const std::string& where) {
  if (text.empty()) return {};
  try {
    return RuleExpression(text);
  } catch (const Error& error) {
    throw Error(error.code(), error.problem(), where + ": " + error.where(), error.hint());
  }
}

double wrapped(double value, Scale scale) {
  return is_angle(scale) ? difference(value, 0, scale) : value;
}

Eigen::Matrix3d covariance_of(double sd, const DerivedShape& shape) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Constant(std::nan(""));
  if (std::isnan(sd)) return covariance;
  const double along = shape.along_sd * shape.along_sd;
  covariance.topLeftCorner<2, 2>() =
      sd * std::abs(sd) * Eigen::Matrix2d::Identity() + along * shape.along * shape.along.transpose();
  return covariance;
}

AttributeValue attribute_value(const MapElement& element, const std::string& from,
                               const AttributeSpec& spec) {
  std::string text;
  if (from.size() > 1 && from.front() == '\'' && from.back() == '\'')
    text = from.substr(1, from.size() - 2);
  else if (const auto tag = element.tags.find(from); tag != element.tags.end())
    text = tag->second;
  if (text.empty()) return {};
  if (spec.kind == AttributeSpec::Kind::text) return text;
  const auto number = parse_tag_number(text);
  if (!number) return {};
  if (spec.kind == AttributeSpec::Kind::integer) return static_cast<std::int64_t>(std::llround(*number));
  return *number;
}

}  // namespace

BoundRule bind_rule(const ImportRule& rule, const TypeRegistry& types, std::size_t number) {
  const std::string where = fmt::format("rule {}, {}", number, rule.title());
  BoundRule bound;
  bound.rule = &rule;
  bound.type = types.id(rule.type);
  const LandmarkType& type = types[bound.type];
  std::vector<std::string> targets = {"z"};
  for (const FeatureSpec& feature : type.features) {
    targets.insert(targets.end(), {feature.name, feature.name + "_sd"});
    const auto text = [&](const std::string& name) {
      const auto found = rule.features.find(name);
      return found == rule.features.end() ? std::string() : found->second;
    };
    bound.features.push_back(parse(text(feature.name), where));
    bound.deviations.push_back(parse(text(feature.name + "_sd"), where));
  }
  std::vector<std::string> words;
  for (const AttributeSpec& attribute : type.attributes) {
    words.push_back(attribute.name);
    const auto found = rule.attributes.find(attribute.name);
    bound.attributes.push_back(found == rule.attributes.end() ? "" : found->second);
  }
  const auto refuse_unknown = [&](const auto& given, const std::vector<std::string>& known,
                                  const char* what) {
    for (const auto& [name, text] : given)
      if (std::ranges::find(known, name) == known.end())
        throw Error(ErrorCode::usage, fmt::format("{} has no {} '{}'", type.name, what, name), where,
                    known.empty() ? "leave it out" : fmt::format("it has {}", fmt::join(known, ", ")));
  };
  refuse_unknown(rule.features, targets, "feature");
  refuse_unknown(rule.attributes, words, "attribute");
  const auto height = rule.features.find("z");
  if (height != rule.features.end()) bound.z = parse(height->second, where);
  bound.position_sd = parse(rule.position_sd, where);
  bound.confidence = parse(rule.confidence, where);
  return bound;
}

Landmark landmark_of_shape(const MapElement& element, const BoundRule& rule, const LandmarkType& type,
                           const DerivedShape& shape) {
  std::map<std::string, std::string> tags = element.tags;
  for (const auto& [name, value] : shape.values) tags["geom_" + name] = fmt::format("{}", value);
  Landmark landmark;
  landmark.type = rule.type;
  if (const auto uid = element.tags.find(rule.rule->uid);
      !rule.rule->uid.empty() && uid != element.tags.end())
    landmark.uid = shape.vertex.empty() ? uid->second : uid->second + "/" + shape.vertex;
  landmark.quality.seen = landmark.quality.visible = 1;
  if (rule.confidence) landmark.confidence = rule.confidence->value(tags);
  landmark.covariance = covariance_of(rule.position_sd ? rule.position_sd->value(tags) : std::nan(""), shape);
  landmark.features.resize(type.features.size());
  landmark.quality.feature_confidences.resize(type.features.size());
  for (std::size_t i = 0; i < type.features.size(); ++i) {
    const FeatureSpec& spec = type.features[i];
    const auto derived = shape.values.find(spec.name);
    const double value = rule.features[i]                ? rule.features[i]->value(tags)
                         : derived != shape.values.end() ? derived->second
                                                         : std::nan("");
    if (std::isnan(value)) continue;
    const double sd = rule.deviations[i] ? rule.deviations[i]->value(tags) : std::nan("");
    landmark.features[i] = {wrapped(value, spec.scale), std::isnan(sd) ? 0 : sd * std::abs(sd), 1};
  }
  for (std::size_t i = 0; i < type.attributes.size(); ++i)
    landmark.attributes.push_back(attribute_value(element, rule.attributes[i], type.attributes[i]));
  return landmark;
}

}  // namespace waymark::importers
