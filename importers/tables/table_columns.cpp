// SPDX-License-Identifier: Apache-2.0
#include "importers/tables/table_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <set>

#include "core/error.hpp"

namespace waymark::importers {
namespace {

constexpr std::array kCommon = {
    "x",    "y",    "z",    "uid",         "confidence", "seen",  "visible", "observations",
    "x_sd", "y_sd", "z_sd", "position_sd", "var_x",      "var_y", "cov_xy",  "var_z"};

/// Pairs of column names that hold a position, the most certain first.
constexpr std::array<std::array<std::string_view, 2>, 11> kPositions = {{{"geom_x", "geom_y"},
                                                                         {"map_x", "map_y"},
                                                                         {"x", "y"},
                                                                         {"longitude", "latitude"},
                                                                         {"lon", "lat"},
                                                                         {"long", "lat"},
                                                                         {"lng", "lat"},
                                                                         {"easting", "northing"},
                                                                         {"east", "north"},
                                                                         {"e", "n"},
                                                                         {"x_coord", "y_coord"}}};

struct Unit {
  std::string_view word;
  const char* times;  // to metres or radians
};
constexpr std::array<Unit, 10> kUnits = {{{"km", "*1000"},
                                          {"cm", "/100"},
                                          {"mm", "/1000"},
                                          {"m", ""},
                                          {"metres", ""},
                                          {"meters", ""},
                                          {"deg", "*pi/180"},
                                          {"degrees", "*pi/180"},
                                          {"rad", ""},
                                          {"radians", ""}}};

/// Returns "diameter_km" for "Diameter (km)".
std::string normal(std::string_view name) {
  std::string result;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte))
      result += static_cast<char>(std::tolower(byte));
    else if (!result.empty() && result.back() != '_')
      result += '_';
  }
  while (result.ends_with('_')) result.pop_back();
  return result;
}

std::string quoted(const std::string& column) {
  const bool plain = !column.empty() && !std::isdigit(static_cast<unsigned char>(column[0])) &&
                     std::ranges::all_of(column, [](unsigned char c) { return std::isalnum(c) || c == '_'; });
  if (plain) return column;
  return column.find('"') == std::string::npos ? '"' + column + '"' : '`' + column + '`';
}

/// Returns the column of that name, with or without a unit, as an expression in metres or radians.
std::optional<std::string> guess(const TableHeader& table, std::string_view wanted) {
  for (const std::string& column : table.columns) {
    const std::string name = normal(column);
    if (name == wanted) return quoted(column);
    if (!name.starts_with(wanted) || name.size() < wanted.size() + 2 || name[wanted.size()] != '_') continue;
    const std::string_view last = std::string_view(name).substr(wanted.size() + 1);
    const auto* unit = std::ranges::find(kUnits, last, &Unit::word);
    if (unit != kUnits.end()) return quoted(column) + unit->times;
  }
  return {};
}

std::vector<std::string> targets_of(const TypeRegistry& types, const std::vector<std::string>& chosen) {
  std::vector<std::string> targets(kCommon.begin(), kCommon.end());
  for (const std::string& name : chosen) {
    const LandmarkType& type = types[types.id(name)];
    for (const FeatureSpec& feature : type.features) {
      targets.push_back(feature.name);
      targets.push_back(feature.name + "_sd");
    }
    for (const AttributeSpec& attribute : type.attributes) targets.push_back(attribute.name);
  }
  std::ranges::sort(targets);
  targets.erase(std::unique(targets.begin(), targets.end()), targets.end());
  return targets;
}

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string_view::npos
             ? ""
             : std::string(text.substr(first, text.find_last_not_of(" \t") - first + 1));
}

void refuse_unknown(const std::string& target, const std::vector<std::string>& targets) {
  if (std::ranges::find(targets, target) != targets.end()) return;
  const std::string nearest = nearest_name(target, targets);
  throw Error(ErrorCode::usage, fmt::format("a landmark of this type has no '{}'", target), "--columns",
              nearest.empty() ? fmt::format("it has {}", fmt::join(targets, ", "))
                              : "did you mean '" + nearest + "'?");
}

class Binder {
 public:
  explicit Binder(const TableHeader& table) : table_(table) {}

  void set(const std::string& target, const std::string& expression) {
    if (!done_.insert(target).second)
      throw Error(ErrorCode::usage, fmt::format("--columns gives '{}' twice", target), "--columns",
                  "remove one of them");
    if (!expression.empty()) bindings_.emplace(target, TableExpression(expression, table_.columns));
  }

  void set_if_free(const std::string& target, const std::optional<std::string>& expression) {
    if (expression && !done_.contains(target)) set(target, *expression);
  }

  void find_position() {
    if (done_.contains("x") || done_.contains("y")) return;
    for (const auto& [x, y] : kPositions) {
      const auto first = guess(table_, x), second = guess(table_, y);
      if (!first || !second) continue;
      set("x", *first);
      set("y", *second);
      return;
    }
  }

  void find_radius() {
    if (done_.contains("radius")) return;
    for (const char* name : {"diameter", "diam", "d", "dia"})
      if (const auto found = guess(table_, name)) return set("radius", *found + "/2");
  }

  ColumnBindings take() {
    for (const char* needed : {"x", "y"})
      if (!bindings_.contains(needed))
        throw Error(ErrorCode::usage, fmt::format("no column of the table is recognised as {}", needed),
                    table_.path,
                    fmt::format("name it, e.g. --columns x=lon,y=lat; the table has {}",
                                fmt::join(table_.columns, ", ")));
    return std::move(bindings_);
  }

 private:
  const TableHeader& table_;
  ColumnBindings bindings_;
  std::set<std::string> done_;
};

}  // namespace

std::vector<ColumnAssignment> column_assignments(const std::string& text) {
  std::vector<std::string> parts(1);
  char quote = 0;
  int depth = 0;
  for (const char c : text) {
    if (quote != 0)
      quote = c == quote ? '\0' : quote;
    else if (c == '"' || c == '`')
      quote = c;
    depth += quote == 0 ? (c == '(') - (c == ')') : 0;
    if (c == ',' && quote == 0 && depth <= 0)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  std::vector<ColumnAssignment> all;
  for (const std::string& part : parts) {
    if (trimmed(part).empty()) continue;
    const std::size_t sign = part.find('=');
    if (sign == std::string::npos)
      throw Error(ErrorCode::usage, fmt::format("'{}' has no target", trimmed(part)), "--columns " + text,
                  "write target=expression, e.g. x=lon,y=lat,radius=diam/2");
    all.push_back({trimmed(part.substr(0, sign)), trimmed(part.substr(sign + 1))});
  }
  return all;
}

bool is_target(const TypeRegistry& types, const std::vector<std::string>& chosen, const std::string& name) {
  const auto targets = targets_of(types, chosen);
  return std::ranges::find(targets, name) != targets.end();
}

ColumnBindings bind_columns(const std::string& text, const TableHeader& table, const TypeRegistry& types,
                            const std::vector<std::string>& chosen) {
  const std::vector<std::string> targets = targets_of(types, chosen);
  Binder binder(table);
  for (const ColumnAssignment& one : column_assignments(text)) {
    refuse_unknown(one.target, targets);
    binder.set(one.target, one.expression);
  }
  binder.find_position();
  if (table.has_points) binder.set_if_free("z", "geom_z");
  for (const std::string& target : targets)
    if (target != "x" && target != "y") binder.set_if_free(target, guess(table, target));
  if (std::ranges::find(targets, "radius") != targets.end()) binder.find_radius();
  return binder.take();
}

bool names_imply_degrees(const ColumnBindings& bindings) {
  const std::string x = normal(bindings.find("x")->second.text()),
                    y = normal(bindings.find("y")->second.text());
  return (x.starts_with("lon") || x.starts_with("lng")) && y.starts_with("lat");
}

}  // namespace waymark::importers
