// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/height_unit.hpp"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <string>

#include "core/error.hpp"

namespace waymark::importers {
namespace {

constexpr double kFoot = 0.3048;               // international, exact
constexpr double kSurveyFoot = 1200.0 / 3937;  // US, exact

struct NamedUnit {
  double metres;
  std::initializer_list<std::string_view> names;
};

}  // namespace

HeightUnit height_unit(std::string_view name) {
  static const NamedUnit units[] = {
      {1, {"", "m", "metre", "metres", "meter", "meters"}},
      {kFoot, {"ft", "foot", "feet", "international foot", "foot (international)"}},
      {kSurveyFoot,
       {"us survey foot", "us survey feet", "us-ft", "ft-us", "ftus", "foot_us", "us_survey_foot"}},
      {1000, {"km", "kilometre", "kilometer", "kilometres", "kilometers"}},
      {0.1, {"dm", "decimetre", "decimeter"}},
      {0.01, {"cm", "centimetre", "centimeter", "centimetres", "centimeters"}},
      {0.001, {"mm", "millimetre", "millimeter"}},
  };
  std::string lower(name);
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const NamedUnit& unit : units)
    if (std::ranges::find(unit.names, lower) != unit.names.end()) return {unit.metres, true};
  return {1, false};
}

HeightUnit stated_height_unit(std::string_view name) {
  const HeightUnit unit = height_unit(name);
  if (!unit.known)
    throw Error(ErrorCode::usage, "there is no unit of height '" + std::string(name) + "'", "height_unit",
                "name one of m, km, dm, cm, mm, ft, us-ft, or pass --height-scale");
  return unit;
}

}  // namespace waymark::importers
