// SPDX-License-Identifier: Apache-2.0
#include "exporters/formatting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "core/units.hpp"

namespace waymark::exporters {
namespace {

constexpr const char* kNarrowSpace = "\u202f";
constexpr const char* kMinus = "\u2212";
constexpr double kFarMetres = 20000;
constexpr std::string_view kFormulaMarks = "=+-@\t\r";  // a spreadsheet computes a cell that begins with one

bool is_number(std::string_view text) {
  double value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  return problem == std::errc() && end == text.data() + text.size();
}

int decimals_for(double largest) {
  const double size = std::abs(largest);
  if (!(size > 0) || size >= 1000) return 0;
  return std::clamp(3 - static_cast<int>(std::ceil(std::log10(size))), 0, 4);
}

}  // namespace

std::string readable_name(std::string_view name) {
  std::string words(name);
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::string title_of(std::string_view name) {
  std::string title = readable_name(name);
  if (!title.empty()) title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
  return title;
}

std::string number_text(double value, int decimals) {
  if (!std::isfinite(value)) return "\u2013";
  std::string digits = fmt::format("{:.{}f}", std::abs(value), decimals);
  const bool zero = digits.find_first_not_of("0.") == std::string::npos;
  const std::size_t whole = std::min(digits.find('.'), digits.size());
  for (std::size_t at = whole; whole > 4 && at > 3;) digits.insert(at -= 3, kNarrowSpace);
  return (value < 0 && !zero ? kMinus : "") + digits;
}

std::string seconds_text(double seconds) {
  const int decimals = seconds < 0.1 ? 3 : seconds < 1 ? 2 : seconds < 10 ? 1 : 0;
  return number_text(seconds, decimals) + "\u00a0s";
}

NumberFormat number_format(const FeatureSpec& feature, double largest) {
  NumberFormat reading{1, feature.unit, 0};
  if (feature.unit == "rad") reading = {1 / kRadiansPerDegree, "\u00b0", 0};
  if (feature.unit == "m" && feature.scale == Scale::ratio && std::abs(largest) >= kFarMetres)
    reading = {1e-3, "km", 0};
  reading.decimals = decimals_for(largest * reading.factor);
  return reading;
}

std::string label_of(const Landmark& landmark, const LandmarkType& type) {
  for (std::size_t i = 0; i < std::min(type.features.size(), landmark.features.size()); ++i) {
    const FeatureValue& feature = landmark.features[i];
    if (type.features[i].name == type.label_feature && feature.known())
      return number_format(type.features[i], feature.value)(feature.value);
  }
  return title_of(type.name) + " " + landmark.uid;
}

std::string spreadsheet_text(std::string_view text) {
  const bool begins_formula = !text.empty() && kFormulaMarks.find(text[0]) != kFormulaMarks.npos;
  return (begins_formula && !is_number(text) ? "'" : "") + std::string(text);
}

std::string csv_text(std::string_view text) {
  const std::string cell = spreadsheet_text(text);
  if (cell.find_first_of(",\"\n\r") == std::string::npos) return cell;
  std::string quoted = "\"";
  for (const char c : cell) c == '"' ? quoted += "\"\"" : quoted += c;
  return quoted + "\"";
}

}  // namespace waymark::exporters
