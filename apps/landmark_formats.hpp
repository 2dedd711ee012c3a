// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>
#include "core/attribute.hpp"
#include "core/landmark.hpp"
#include "geo/crs.hpp"
#include "landmarks/landmark_type.hpp"
#include "landmarks/sensor_profile.hpp"
namespace waymark::apps {

/// Column of printed landmarks.
struct RowColumn {
  std::string name, unit;
  bool brief = false;                                    ///< shown in the table for people
  std::function<AttributeValue(const Landmark&)> value;  ///< std::monostate if the landmark has none
};

/// Input of the columns besides the chosen types.
struct RowContext {
  const TypeRegistry* types = nullptr;    ///< of the map
  const SensorProfile* sensor = nullptr;  ///< whose quality is shown; null: equal weights
  std::function<double(const Landmark&)> distance =
      {};  ///< metres, from the point asked for; empty: no such column
};

/// Returns type, uid, x, y, z, the map's columns of every chosen type (equal names once), and `distance`. The
/// registry and the sensor must outlive them.
std::vector<RowColumn> row_columns(const std::vector<std::string>& chosen, const RowContext& context);

// Landmarks on standard output. Numbers round-trip, except in the table for people. Unknown values are empty
// or null.

/// Prints the brief columns, aligned, with units.
void print_table(std::ostream& out, std::span<const RowColumn> columns, std::span<const Landmark> landmarks,
                 const Crs& crs);
/// Prints RFC 4180 with a header; lines end in \n.
void print_csv(std::ostream& out, std::span<const RowColumn> columns, std::span<const Landmark> landmarks);
/// Prints an array with one object per line.
void print_json(std::ostream& out, std::span<const RowColumn> columns, std::span<const Landmark> landmarks);
/// Prints RFC 7946, one feature per line. Positions must be longitude and latitude in degrees.
void print_geojson(std::ostream& out, std::span<const RowColumn> columns,
                   std::span<const Landmark> landmarks);

}  // namespace waymark::apps
