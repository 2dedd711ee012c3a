// SPDX-License-Identifier: Apache-2.0
#include "geodb/type_catalogue.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/error.hpp"

namespace waymark {
namespace {

constexpr std::array<std::string_view, 3> kScales = {"ratio", "interval", "axis"};
constexpr std::array<std::string_view, 3> kKinds = {"real", "integer", "text"};
constexpr std::array<std::string_view, 5> kSolids = {"point", "sphere", "cylinder", "cone", "bowl"};

template <class Enum>
std::string_view word(Enum value, const auto& words) {
  return words.at(static_cast<std::size_t>(value));
}

template <class Enum>
Enum from_word(std::string_view text, const auto& words) {
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
                        from_word<Scale>(row.text(2), kScales), row.optional_real(3).value_or(-infinity),
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
                          from_word<AttributeSpec::Kind>(row.text(2), kKinds), std::string(row.text(3))});
  return attributes;
}

}  // namespace

void write_types(const sqlite::Database& database, const TypeRegistry& types) {
  sqlite::Statement insert_type = database.prepare(
      "INSERT INTO waymark_type (name, summary, drawn_as, colour, label_feature, size_feature) VALUES (?, ?, "
      "?, ?, ?, ?)");
  sqlite::Statement insert_feature = database.prepare(
      "INSERT INTO waymark_feature (type, position, name, unit, scale, lowest, highest, reference, summary)"
      "  VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)");
  sqlite::Statement insert_attribute = database.prepare(
      "INSERT INTO waymark_attribute (type, position, name, unit, kind, summary) VALUES (?, ?, ?, ?, ?, ?)");
  for (const auto& type : types) {
    insert_type.bind_all(type.name, type.summary, word(type.drawn_as, kSolids), type.colour,
                         type.label_feature, type.size_feature);
    insert_type.run();
    int position = 0;
    for (const auto& f : type.features) {
      insert_feature.bind_all(type.name, position++, f.name, f.unit, word(f.scale, kScales),
                              bounded(f.lowest), bounded(f.highest), f.reference, f.summary);
      insert_feature.run();
    }
    position = 0;
    for (const auto& a : type.attributes) {
      insert_attribute.bind_all(type.name, position++, a.name, a.unit, word(a.kind, kKinds), a.summary);
      insert_attribute.run();
    }
  }
}

TypeRegistry read_types(const sqlite::Database& database) {
  TypeRegistry types;
  sqlite::Statement row = database.prepare(
      "SELECT name, summary, drawn_as, colour, label_feature, size_feature FROM waymark_type ORDER BY id");
  try {
    while (row.step()) {
      const std::string name(row.text(0));
      types.add({.name = name,
                 .summary = std::string(row.text(1)),
                 .features = read_features(database, name),
                 .attributes = read_attributes(database, name),
                 .drawn_as = from_word<Solid>(row.text(2), kSolids),
                 .colour = std::string(row.text(3)),
                 .label_feature = std::string(row.text(4)),
                 .size_feature = std::string(row.text(5))});
    }
  } catch (const std::logic_error& fault) {
    throw Error(ErrorCode::input, std::string("the map's landmark types are damaged: ") + fault.what(),
                "tables waymark_type, waymark_feature, waymark_attribute", "run its job again");
  }
  return types;
}

}  // namespace waymark
