// SPDX-License-Identifier: Apache-2.0
#include "importers/rules/drawing_unit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "importers/vsi_file.hpp"

namespace waymark::importers {
namespace {

struct KnownUnit {
  std::string_view name;
  double metres;
  int code;  // of $INSUNITS
};
constexpr std::array<KnownUnit, 10> kKnownUnits = {{{"m", 1, 6},
                                                    {"dm", 0.1, 14},
                                                    {"cm", 0.01, 5},
                                                    {"mm", 0.001, 4},
                                                    {"km", 1000, 7},
                                                    {"in", 0.0254, 1},
                                                    {"ft", 0.3048, 2},
                                                    {"yd", 0.9144, 10},
                                                    {"mi", 1609.344, 3},
                                                    {"us_ft", 1200.0 / 3937, 21}}};
constexpr std::size_t kHeaderBytes = 1 << 20;  // headers have some 20 kB

DrawingUnit as_drawing_unit(const KnownUnit& unit) {
  return {std::string(unit.name), unit.metres};
}

std::string_view without_blanks(std::string_view line) {
  const std::size_t from = line.find_first_not_of(" \t\r");
  if (from == std::string_view::npos) return {};
  return line.substr(from, line.find_last_not_of(" \t\r") - from + 1);
}

}  // namespace

DrawingUnit drawing_unit(const std::string& name) {
  std::vector<std::string_view> names;
  for (const KnownUnit& unit : kKnownUnits) {
    if (unit.name == name) return as_drawing_unit(unit);
    names.push_back(unit.name);
  }
  throw Error(ErrorCode::usage, fmt::format("there is no unit '{}'", name), "--unit",
              fmt::format("it is one of {}", fmt::join(names, ", ")));
}

std::optional<DrawingUnit> read_dxf_unit(const std::string& path) {
  std::string text(kHeaderBytes, '\0');
  text.resize(VsiFile(path).read(0, text.data(), text.size()));
  // Lines come in pairs: a code and a value. The variable's value follows its name.
  std::string_view rest = text;
  const auto line = [&] {
    const std::size_t end = rest.find('\n');
    const std::string_view first = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    return without_blanks(first);
  };
  while (!rest.empty()) {
    const std::string_view code = line(), value = line();
    if (code == "0" && value == "ENDSEC") return {};
    if (code != "9" || value != "$INSUNITS") continue;
    line();
    const std::string_view number = line();
    int unit = 0;
    std::from_chars(number.data(), number.data() + number.size(), unit);
    const auto* known = std::ranges::find(kKnownUnits, unit, &KnownUnit::code);
    return known == kKnownUnits.end() ? std::nullopt : std::optional(as_drawing_unit(*known));
  }
  return {};
}

}  // namespace waymark::importers
