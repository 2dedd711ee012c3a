// SPDX-License-Identifier: Apache-2.0
#include "apps/landmark_rows.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "exporters/vector/export_columns.hpp"

namespace waymark::apps {
namespace {

using Value = std::function<AttributeValue(const Landmark&)>;

AttributeValue or_null(std::optional<double> value) {
  return value && std::isfinite(*value) ? AttributeValue(*value) : AttributeValue();
}

Value coordinate(int axis) {
  return [axis](const Landmark& landmark) { return or_null(landmark.position.xyz[axis]); };
}

/// Joins columns of one name, by type; a landmark of another type has no value.
Value by_type(std::map<TypeId, Value> values) {
  return [values = std::move(values)](const Landmark& landmark) {
    const auto found = values.find(landmark.type);
    return found == values.end() ? AttributeValue() : found->second(landmark);
  };
}

Value quality_column(const RowContext& context) {
  return [context](const Landmark& landmark) {
    const LandmarkType& type = (*context.types)[landmark.type];
    return or_null(context.sensor ? quality_for(*context.sensor, type, landmark)
                                  : quality_of(type, landmark));
  };
}

bool is_feature(const LandmarkType& type, const std::string& name) {
  return std::ranges::count(type.features, name, &FeatureSpec::name) > 0;
}

}  // namespace

std::vector<RowColumn> row_columns(const std::vector<std::string>& chosen, const RowContext& context) {
  const TypeRegistry& types = *context.types;
  std::vector<RowColumn> columns{
      {"type", "", true,
       [&types](const Landmark& landmark) { return AttributeValue(types[landmark.type].name); }},
      {"uid", "", true, [](const Landmark& landmark) { return AttributeValue(landmark.uid); }},
      {"x", "", true, coordinate(0)},
      {"y", "", true, coordinate(1)},
      {"z", "m", false, coordinate(2)}};
  std::vector<RowColumn> more;
  std::map<std::string, std::map<TypeId, Value>> values;
  for (const std::string& name : chosen) {
    const TypeId id = types.id(name);
    for (const exporters::ExportColumn& column : exporters::export_columns(types[id])) {
      if (column.name == "uid") continue;
      if (!values.contains(column.name))
        more.push_back(
            {column.name,
             column.unit,
             is_feature(types[id], column.name) || column.name == "quality" || column.name == "confidence",
             {}});
      values[column.name][id] = column.name == "quality" ? quality_column(context) : column.value;
    }
  }
  for (RowColumn& column : more) {
    column.value = by_type(std::move(values[column.name]));
    columns.push_back(std::move(column));
  }
  if (context.distance)
    columns.push_back({"distance", "m", true,
                       [context](const Landmark& landmark) { return or_null(context.distance(landmark)); }});
  return columns;
}

}  // namespace waymark::apps
