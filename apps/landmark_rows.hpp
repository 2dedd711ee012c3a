// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>
#include "core/attribute.hpp"
#include "core/landmark.hpp"
#include "landmarks/landmark_type.hpp"
#include "landmarks/sensor_profile.hpp"
namespace waymark {

/// A column of printed landmarks of one type or several.
struct RowColumn {
  std::string name, unit;
  bool brief = false;                                    ///< worth its place in a table for people
  std::function<AttributeValue(const Landmark&)> value;  ///< std::monostate where the landmark has none
};

/// What the columns depend on beside the types.
struct RowContext {
  const TypeRegistry* types = nullptr;    ///< of the map
  const SensorProfile* sensor = nullptr;  ///< whose quality is shown; null: equal weights
  std::function<double(const Landmark&)> distance =
      {};  ///< metres, from the point asked for; empty: no such column
};

/// type, uid, x, y, z, then the columns of the map for every type that is chosen, equal names once;
/// `distance` last. The registry and the sensor must outlive them.
std::vector<RowColumn> row_columns(const std::vector<std::string>& chosen, const RowContext& context);

}  // namespace waymark
