// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include "core/feature.hpp"
#include "core/landmark.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark {

/// "mountain_top" reads "mountain top".
std::string spoken(std::string_view name);

/// "mountain_top" reads "Mountain top".
std::string title_of(std::string_view name);

/// Thousands set apart by a narrow space: 12 345. `decimals` as given; not a number reads as a dash.
std::string number_text(double value, int decimals = 0);

/// Two digits that count, or three: 0.31 s, 4.2 s, 615 s; nothing finer than a millisecond.
std::string seconds_text(double seconds);

/// How the values of one feature are written side by side: one unit and one precision, chosen by the largest.
/// Metres become kilometres for a ratio feature beyond 20 km (never for elevations); radians become degrees.
struct Reading {
  double factor = 1;  ///< value in `unit` = value in the feature's unit times this
  std::string unit;   ///< may be empty
  int decimals = 0;   ///< about four digits of the largest value

  std::string number(double value) const { return number_text(value * factor, decimals); }
  std::string operator()(double value) const { return number(value) + (unit.empty() ? "" : "\u00a0" + unit); }
};
Reading reading_of(const FeatureSpec& feature, double largest);

/// What a map writes beside a landmark: its label feature, else its type and uid.
std::string label_of(const Landmark& landmark, const LandmarkType& type);

/// Text that may stand in HTML or XML.
std::string escaped(std::string_view text);

}  // namespace waymark
