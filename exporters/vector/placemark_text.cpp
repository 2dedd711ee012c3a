// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/placemark_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>

#include "exporters/formatting.hpp"
#include "exporters/vector/export_columns.hpp"

namespace waymark::exporters {
namespace {

std::string row(const std::string& title, const std::string& text) {
  return fmt::format("<tr><td>{}</td><td>{}</td></tr>", escape_markup(title), escape_markup(text));
}

std::string feature_text(const FeatureValue& feature, const FeatureSpec& spec) {
  const NumberFormat read = number_format(spec, feature.value);
  const std::string spread = feature.variance > 0 ? " \u00b1 " + read(std::sqrt(feature.variance)) : "";
  return read(feature.value) + spread;
}

/// Returns the attribute `name`; empty if the type has none or the landmark has no name.
std::string own_name(const Landmark& landmark, const LandmarkType& type) {
  const auto found = std::ranges::find(type.attributes, "name", &AttributeSpec::name);
  const auto index = static_cast<std::size_t>(found - type.attributes.begin());
  const auto* name =
      index < landmark.attributes.size() ? std::get_if<std::string>(&landmark.attributes[index]) : nullptr;
  return name ? *name : "";
}

}  // namespace

std::string placemark_name(const Landmark& landmark, const LandmarkType& type) {
  if (std::string name = own_name(landmark, type); !name.empty()) return name;
  return type.label_feature.empty() ? title_of(type.name)
                                    : title_of(type.name) + " " + label_of(landmark, type);
}

std::string placemark_description(const Landmark& landmark, const LandmarkType& type) {
  std::string rows;
  for (std::size_t i = 0; i < std::min(type.features.size(), landmark.features.size()); ++i)
    if (landmark.features[i].known())
      rows += row(title_of(type.features[i].name), feature_text(landmark.features[i], type.features[i]));
  if (const auto quality = equal_weight_quality(landmark)) rows += row("Quality", number_text(*quality, 2));
  rows += row("Confidence", number_text(landmark.confidence, 2));
  rows += row("Name in the map", landmark.uid);
  return fmt::format("<p>{}</p><table>{}</table>", escape_markup(type.summary), rows);
}

}  // namespace waymark::exporters
