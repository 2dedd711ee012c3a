// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <iosfwd>
#include <span>
#include "apps/landmark_rows.hpp"
#include "geo/crs.hpp"
namespace waymark {

// Landmarks on standard output. Numbers have all their digits, so that they read back as they were, except in
// the table for people. A value that is not known is empty, or null.

/// Aligned columns with units, the brief ones only.
void print_table(std::ostream& out, std::span<const RowColumn> columns, std::span<const Landmark> landmarks,
                 const Crs& crs);
/// RFC 4180, with a header; lines end in \n.
void print_csv(std::ostream& out, std::span<const RowColumn> columns, std::span<const Landmark> landmarks);
/// An array with one object per line.
void print_json(std::ostream& out, std::span<const RowColumn> columns, std::span<const Landmark> landmarks);
/// RFC 7946, one feature per line: positions must be longitude and latitude in degrees.
void print_geojson(std::ostream& out, std::span<const RowColumn> columns,
                   std::span<const Landmark> landmarks);

}  // namespace waymark
