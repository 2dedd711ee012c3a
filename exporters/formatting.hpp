// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include "core/escape_markup.hpp"
#include "core/feature.hpp"
#include "core/landmark.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::exporters {

/// Returns "mountain top" for "mountain_top".
std::string readable_name(std::string_view name);

/// Returns "Mountain top" for "mountain_top".
std::string title_of(std::string_view name);

/// Formats a number with thousands separated by a narrow space: 12 345. NaN becomes a dash.
std::string number_text(double value, int decimals = 0);

/// Formats a duration with two or three significant digits: 0.31 s, 4.2 s, 615 s; nothing finer than a
/// millisecond.
std::string seconds_text(double seconds);

/// Unit and precision for the values of one feature in a table. Metres become kilometres for a ratio feature
/// beyond 20 km (never for elevations); radians become degrees.
struct NumberFormat {
  double factor = 1;  ///< value in `unit` = value in the feature's unit times this
  std::string unit;   ///< may be empty
  int decimals = 0;   ///< about four digits of the largest value

  std::string number(double value) const { return number_text(value * factor, decimals); }
  std::string operator()(double value) const { return number(value) + (unit.empty() ? "" : "\u00a0" + unit); }
};
/// Chooses unit and precision for values up to `largest`.
NumberFormat number_format(const FeatureSpec& feature, double largest);

/// Returns the map label of a landmark: its label feature, else its type and uid.
std::string label_of(const Landmark& landmark, const LandmarkType& type);

/// Returns a text that no spreadsheet computes: a formula gets an apostrophe in front, which the table reader
/// removes.
std::string spreadsheet_text(std::string_view text);

/// Returns spreadsheet_text as a cell of a CSV table, quoted if necessary.
std::string csv_text(std::string_view text);

}  // namespace waymark::exporters
