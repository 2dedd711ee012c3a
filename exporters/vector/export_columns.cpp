// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/export_columns.hpp"

#include <cmath>

#include "core/landmark.hpp"
#include "landmarks/assessed_quality.hpp"

namespace waymark::exporters {
namespace {

using Kind = AttributeSpec::Kind;

AttributeValue or_null(std::optional<double> value) {
  return value && std::isfinite(*value) ? AttributeValue(*value) : AttributeValue();
}

void add_feature(std::vector<ExportColumn>& columns, const FeatureSpec& feature, std::size_t i) {
  const auto known = [i](const Landmark& l) { return i < l.features.size() && l.features[i].known(); };
  columns.push_back({feature.name, feature.unit, feature.summary, Kind::real, [=](const Landmark& l) {
                       return known(l) ? or_null(l.features[i].value) : AttributeValue();
                     }});
  columns.push_back({feature.name + "_sd", feature.unit, "Standard deviation of " + feature.name, Kind::real,
                     [=](const Landmark& l) {
                       const bool spread = known(l) && l.features[i].variance > 0;
                       return spread ? AttributeValue(std::sqrt(l.features[i].variance)) : AttributeValue();
                     }});
  columns.push_back(
      {feature.name + "_q", "", "Confidence in " + feature.name, Kind::real, [=](const Landmark& l) {
         return i < l.quality.feature_confidences.size() ? or_null(l.quality.feature_confidences[i])
                                                         : AttributeValue();
       }});
}

void add_attribute(std::vector<ExportColumn>& columns, const AttributeSpec& attribute, std::size_t i) {
  columns.push_back(
      {attribute.name, attribute.unit, attribute.summary, attribute.kind,
       [i](const Landmark& l) { return i < l.attributes.size() ? l.attributes[i] : AttributeValue(); }});
}

void add_count(std::vector<ExportColumn>& columns, const char* name, const char* summary,
               int (*count)(const Landmark&)) {
  columns.push_back({name, "", summary, Kind::integer, [count](const Landmark& l) {
                       return AttributeValue(static_cast<std::int64_t>(count(l)));
                     }});
}

void add_real(std::vector<ExportColumn>& columns, const char* name, const char* unit, const char* summary,
              std::optional<double> (*value)(const Landmark&)) {
  columns.push_back(
      {name, unit, summary, Kind::real, [value](const Landmark& l) { return or_null(value(l)); }});
}

std::optional<double> if_known(double value) {
  return std::isnan(value) ? std::nullopt : std::optional(value);
}

std::optional<double> multiplicity(const Landmark& l) {
  return multiplicity_confidence(l.quality.seen, l.quality.visible);
}

}  // namespace

std::vector<ExportColumn> export_columns(const LandmarkType& type) {
  using Real = std::optional<double>;
  std::vector<ExportColumn> columns;
  columns.push_back(
      {"uid", "", "Stable name", Kind::text, [](const Landmark& l) { return AttributeValue(l.uid); }});
  for (std::size_t i = 0; i < type.features.size(); ++i) add_feature(columns, type.features[i], i);
  add_count(columns, "seen", "Images or surveys that detected it",
            [](const Landmark& l) { return l.quality.seen; });
  add_count(columns, "visible", "Images or surveys that could have",
            [](const Landmark& l) { return l.quality.visible; });
  add_real(columns, "q_multiplicity", "", "Fraction of them that did", multiplicity);
  add_real(columns, "quality", "", "Landmark quality, equal weights; unknown if seen once of once",
           equal_weight_quality);
  add_real(columns, "confidence", "", "Probability that it exists",
           [](const Landmark& l) { return Real(l.confidence); });
  add_real(columns, "var_x", "m2", "Variance eastwards",
           [](const Landmark& l) { return if_known(l.covariance(0, 0)); });
  add_real(columns, "var_y", "m2", "Variance northwards",
           [](const Landmark& l) { return if_known(l.covariance(1, 1)); });
  add_real(columns, "cov_xy", "m2", "Covariance east-north",
           [](const Landmark& l) { return if_known(l.covariance(0, 1)); });
  add_real(columns, "var_z", "m2", "Variance of the height",
           [](const Landmark& l) { return if_known(l.covariance(2, 2)); });
  add_count(columns, "observations", "Observations merged into it",
            [](const Landmark& l) { return l.observations; });
  for (std::size_t i = 0; i < type.attributes.size(); ++i) add_attribute(columns, type.attributes[i], i);
  return columns;
}

std::optional<double> equal_weight_quality(const Landmark& landmark) {
  const std::vector<double> weights(landmark.quality.feature_confidences.size(), 1.0);
  if (!is_quality_assessed(landmark.quality, weights)) return std::nullopt;
  return landmark_quality(multiplicity(landmark), landmark.quality.feature_confidences, weights);
}

}  // namespace waymark::exporters
