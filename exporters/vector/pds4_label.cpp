// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/pds4_label.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>

#include "core/error.hpp"

namespace waymark::exporters {
namespace {

// Of GDAL's default template for tables.
constexpr std::array kVariables = {"LOGICAL_IDENTIFIER",
                                   "TITLE",
                                   "INVESTIGATION_AREA_NAME",
                                   "INVESTIGATION_AREA_LID_REFERENCE",
                                   "OBSERVING_SYSTEM_NAME",
                                   "TARGET",
                                   "TARGET_TYPE"};

}  // namespace

std::vector<std::string> pds4_label(std::span<const std::string> given, const std::string& title,
                                    const Crs& crs, const std::string& suffix) {
  std::map<std::string, std::string> values{{"TITLE", title}};
  if (crs.kind() != CrsKind::local && !crs.body().name.empty()) {
    values["TARGET"] = crs.body().name;
    values["TARGET_TYPE"] = crs.body().name == "Moon" ? "Satellite" : "Planet";
  }
  for (const std::string& text : given) {
    const std::string name = text.substr(0, text.find('='));
    if (std::ranges::find(kVariables, name) == kVariables.end() || name.size() + 1 >= text.size())
      throw Error(ErrorCode::usage, fmt::format("'{}' is no value of a PDS4 label", text), "--label",
                  fmt::format("write NAME=VALUE; names: {}", fmt::join(kVariables, ", ")));
    values[name] = text.substr(name.size() + 1);
  }
  if (const auto id = values.find("LOGICAL_IDENTIFIER"); id != values.end()) {
    if (!id->second.starts_with("urn:"))
      throw Error(ErrorCode::usage, fmt::format("'{}' is no logical identifier", id->second), "--label",
                  "it is a URN: LOGICAL_IDENTIFIER=urn:nasa:pds:bundle:collection:product");
    id->second += suffix;
  }
  std::vector<std::string> options;
  // Latitudes of PROJ are planetographic; on a sphere both kinds agree.
  if (crs.kind() != CrsKind::local && crs.body().flattening > 0)
    options.emplace_back("LATITUDE_TYPE=Planetographic");
  for (const auto& [name, value] : values) options.push_back("VAR_" + name + "=" + value);
  return options;
}

}  // namespace waymark::exporters
