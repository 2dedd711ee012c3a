// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <iosfwd>
#include <span>
#include "apps/landmark_rows.hpp"
#include "geo/crs.hpp"
namespace waymark::apps {

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
