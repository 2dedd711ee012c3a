// SPDX-License-Identifier: Apache-2.0
#include "geodb/geopackage/type_catalogue.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/error.hpp"
#include "landmarks/colour.hpp"

namespace waymark::geodb {
namespace {

constexpr std::array<std::string_view, 4> kScales = {"ratio", "interval", "axis", "direction"};
constexpr std::array<std::string_view, 3> kKinds = {"real", "integer", "text"};
constexpr std::array<std::string_view, 5> kSolids = {"point", "sphere", "cylinder", "cone", "bowl"};

template <class Enum>
std::string_view enum_name(Enum value, const auto& words) {
  return words.at(static_cast<std::size_t>(value));
}

template <class Enum>
Enum parse_enum(std::string_view text, const auto& words) {
  for (std::size_t i = 0; i < words.size(); ++i)
    if (words[i] == text) return static_cast<Enum>(i);
  throw std::logic_error("unknown word '" + std::string(text) + "'");
}

std::optional<double> bounded(double limit) {
  return std::isfinite(limit) ? std::optional(limit) : std::nullopt;
}

std::vector<FeatureSpec> read_features(const sqlite::Database& database, std::string_view type) {
  std::vector<FeatureSpec> features;
  sqlite::Statement row = database.prepare(
      "SELECT name, unit, scale, lowest, highest, summary, reference FROM waymark_feature"
      "  WHERE type = ? ORDER BY position");
  row.bind(1, type);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  while (row.step())
    features.push_back({std::string(row.text(0)), std::string(row.text(1)),
                        parse_enum<Scale>(row.text(2), kScales), row.optional_real(3).value_or(-infinity),
                        row.optional_real(4).value_or(infinity), std::string(row.text(5)), row.real(6)});
  return features;
}

std::vector<AttributeSpec> read_attributes(const sqlite::Database& database, std::string_view type) {
  std::vector<AttributeSpec> attributes;
  sqlite::Statement row = database.prepare(
      "SELECT name, unit, kind, summary FROM waymark_attribute WHERE type = ? ORDER BY position");
  row.bind(1, type);
  while (row.step())
    attributes.push_back({std::string(row.text(0)), std::string(row.text(1)),
                          parse_enum<AttributeSpec::Kind>(row.text(2), kKinds), std::string(row.text(3))});
  return attributes;
}

/// Returns the feature that a style or body refers to; empty if the type has none of that name.
std::string existing_feature(std::string_view name, const std::vector<FeatureSpec>& features) {
  return std::ranges::find(features, name, &FeatureSpec::name) == features.end() ? "" : std::string(name);
}

}  // namespace

void write_types(const sqlite::Database& database, const TypeRegistry& types) {
  sqlite::Statement insert_type = database.prepare(
      "INSERT INTO waymark_type (name, summary, evidence, body_feature, radius_per_value,"
      "  identification_reach, identifies_itself, drawn_as, colour, label_feature, size_feature)"
      "  VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  sqlite::Statement insert_feature = database.prepare(
      "INSERT INTO waymark_feature (type, position, name, unit, scale, lowest, highest, reference, summary)"
      "  VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)");
  sqlite::Statement insert_attribute = database.prepare(
      "INSERT INTO waymark_attribute (type, position, name, unit, kind, summary) VALUES (?, ?, ?, ?, ?, ?)");
  for (const auto& type : types) {
    insert_type.bind_all(type.name, type.summary, to_string(type.evidence), type.body.feature,
                         type.body.radius_per_value, type.identification_reach,
                         static_cast<int>(type.identifies_itself), enum_name(type.drawn_as, kSolids),
                         type.colour, type.label_feature, type.size_feature);
    insert_type.run();
    int position = 0;
    for (const auto& f : type.features) {
      insert_feature.bind_all(type.name, position++, f.name, f.unit, enum_name(f.scale, kScales),
                              bounded(f.min_value), bounded(f.max_value), f.reference, f.summary);
      insert_feature.run();
    }
    position = 0;
    for (const auto& a : type.attributes) {
      insert_attribute.bind_all(type.name, position++, a.name, a.unit, enum_name(a.kind, kKinds), a.summary);
      insert_attribute.run();
    }
  }
}

TypeRegistry read_types(const sqlite::Database& database) {
  TypeRegistry types;
  sqlite::Statement row = database.prepare(
      "SELECT name, summary, drawn_as, colour, label_feature, size_feature, evidence, body_feature,"
      "  radius_per_value, identification_reach, identifies_itself FROM waymark_type ORDER BY id");
  try {
    while (row.step()) {
      const std::string name(row.text(0));
      std::vector<FeatureSpec> features = read_features(database, name);
      const std::string label = existing_feature(row.text(4), features);
      const std::string size = existing_feature(row.text(5), features);
      const BodySize body{existing_feature(row.text(7), features), row.real(8)};
      types.add({.name = name,
                 .summary = std::string(row.text(1)),
                 .features = std::move(features),
                 .attributes = read_attributes(database, name),
                 .evidence = parse_evidence_model(row.text(6)),
                 .body = body,
                 .identification_reach = row.real(9),
                 .identifies_itself = row.integer(10) != 0,
                 .drawn_as = parse_enum<Solid>(row.text(2), kSolids),
                 .colour = is_colour(row.text(3)) ? std::string(row.text(3)) : LandmarkType{}.colour,
                 .label_feature = label,
                 .size_feature = size});
    }
  } catch (const std::logic_error& fault) {
    throw Error(ErrorCode::input, std::string("the map's landmark types are damaged: ") + fault.what(),
                "tables waymark_type, waymark_feature, waymark_attribute", "run its job again");
  }
  return types;
}

}  // namespace waymark::geodb
