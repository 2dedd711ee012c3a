// SPDX-License-Identifier: Apache-2.0
#include "geodb/layers/landmark_layout.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <set>
#include <type_traits>

#include "core/error.hpp"
#include "core/landmark.hpp"
#include "geodb/geopackage/geometry_blob.hpp"
#include "geodb/sqlite/attribute_column.hpp"
#include "geodb/sqlite/sql_text.hpp"
#include "landmarks/sensor_profile.hpp"

namespace waymark::geodb {
namespace {

constexpr std::array kOurTables = {"observation", "image", "run", "landmark", "layer_styles", "dem"};
constexpr std::array kReservedPrefixes = {"gpkg", "rtree_", "sqlite_", "waymark_"};

void check_name(const std::string& table) {
  bool taken = std::ranges::find(kOurTables, table) != kOurTables.end() || table.ends_with("_observation");
  for (const std::string_view prefix : kReservedPrefixes) taken = taken || table.starts_with(prefix);
  if (taken)
    throw Error(ErrorCode::usage, "a map cannot have a landmark type named '" + table + "'", "",
                "that table is the map's own: choose another name");
}

/// Returns the heading of a column: "Prominence low (m)" of prominence_low.
std::string heading(std::string name, const std::string& unit) {
  std::ranges::replace(name, '_', ' ');
  if (!name.empty() && name[0] >= 'a' && name[0] <= 'z') name[0] = static_cast<char>(name[0] - 'a' + 'A');
  return unit.empty() ? name : name + " (" + unit + ")";
}

const std::vector<LandmarkColumn>& common_columns() {
  static const std::vector<LandmarkColumn> columns = {
      {"seen", "INTEGER NOT NULL DEFAULT 0", "Seen", "Images or surveys that detected it"},
      {"visible", "INTEGER NOT NULL DEFAULT 0", "Visible", "Images or surveys that could have"},
      {"q_multiplicity", "DOUBLE", "Seen / visible", "Multiplicity confidence seen / visible, 0 to 1"},
      {"quality", "DOUBLE", "Quality",
       "Landmark quality with equal feature weights, 0 to 1; NULL: not assessed, seen once of once"},
      {"confidence", "DOUBLE NOT NULL DEFAULT 1", "Confidence",
       "Probability that the landmark exists, 0 to 1"},
      {"var_x", "DOUBLE", "Variance east (m2)", "Variance of the position to the east; NULL: unknown"},
      {"var_y", "DOUBLE", "Variance north (m2)", "Variance of the position to the north; NULL: unknown"},
      {"cov_xy", "DOUBLE", "Covariance east-north (m2)", "Covariance of east and north; NULL: unknown"},
      {"var_z", "DOUBLE", "Variance of height (m2)",
       "Variance of the height; NULL: unknown, as may be the height"},
      {"observations", "INTEGER NOT NULL DEFAULT 0", "Observations", "Observations merged into it"},
  };
  return columns;
}

std::string names_of(std::span<const LandmarkColumn> columns, std::string_view before) {
  std::vector<std::string> names;
  for (const auto& column : columns) names.push_back(std::string(before) + quote_identifier(column.name));
  return fmt::format("{}", fmt::join(names, ", "));
}

std::optional<double> spread(const FeatureValue& feature) {
  if (feature.observations < 2 && !(feature.variance > 0)) return std::nullopt;
  return std::sqrt(feature.variance);
}

/// Calls `take` with the value of each column after the uid, in their order.
template <class Take>
void visit_values(const LandmarkType& type, const Landmark& landmark, const Take& take) {
  for (std::size_t i = 0; i < type.features.size(); ++i) {
    const bool known = i < landmark.features.size() && landmark.features[i].known();
    const FeatureValue value = known ? landmark.features[i] : FeatureValue{};
    const auto& confidences = landmark.quality.feature_confidences;
    take(value.value);
    take(spread(value));
    take(known && i < confidences.size() ? confidences[i] : std::nullopt);
  }
  const auto& [seen, visible, feature_confidences] = landmark.quality;
  const auto& covariance = landmark.covariance;
  take(seen);
  take(visible);
  take(multiplicity_confidence(seen, visible));
  take(quality_of(type, landmark));
  for (const double value :
       {landmark.confidence, covariance(0, 0), covariance(1, 1), covariance(0, 1), covariance(2, 2)})
    take(value);
  take(landmark.observations);
  static const AttributeValue none;  // texts are bound by reference, so it must outlive the loop
  for (std::size_t i = 0; i < type.attributes.size(); ++i)
    take(i < landmark.attributes.size() ? landmark.attributes[i] : none);
}

double number_of(double value) {
  return value;
}
double number_of(std::optional<double> value) {
  return value.value_or(std::nan(""));
}
double number_of(int value) {
  return value;
}
double number_of(const AttributeValue& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
  const auto* real = std::get_if<double>(&value);
  return real != nullptr ? *real : std::nan("");
}

}  // namespace

LandmarkLayout::LandmarkLayout(const LandmarkType& type, TypeId id) : type_(&type), id_(id) {
  check_name(type.name);
  columns_ = {
      {"id", "INTEGER PRIMARY KEY", "Row", "Row; unique over all landmark types of the map"},
      {"geom", "POINT", "Position", "Position and height in the map's CRS"},
      {"uid", "TEXT", "Name", "Name that stays the same over runs; made by a trigger if it is not given"}};
  for (const auto& f : type.features) {
    columns_.push_back({f.name, "DOUBLE", heading(f.name, f.unit), f.summary});
    columns_.push_back({f.name + "_sd", "DOUBLE", heading(f.name + " deviation", f.unit),
                        "Standard deviation, by docs/reference/map.md of Waymark; NULL: unknown"});
    columns_.push_back({f.name + "_q", "DOUBLE", heading(f.name + " agreement", ""),
                        "Variance confidence, 0 to 1; NULL where one observation gives no spread"});
  }
  columns_.insert(columns_.end(), common_columns().begin(), common_columns().end());
  for (const auto& a : type.attributes)
    columns_.push_back({a.name, sql_type(a.kind), heading(a.name, a.unit), a.summary});

  std::set<std::string_view> names;
  for (const auto& column : columns_)
    if (!names.insert(column.name).second)
      throw Error(ErrorCode::usage,
                  fmt::format("landmark type '{}' would have two columns named '{}'", type.name, column.name),
                  "", "rename the feature or attribute");
}

std::string LandmarkLayout::create_table() const {
  std::vector<std::string> lines;
  for (const auto& column : columns_)
    lines.push_back("  " + quote_identifier(column.name) + " " + column.sql_type);
  return fmt::format("CREATE TABLE {} (\n{}\n)", quote_identifier(type_->name), fmt::join(lines, ",\n"));
}

std::string LandmarkLayout::insert() const {
  std::string placeholders = "?";
  for (std::size_t i = 1; i < columns_.size(); ++i) placeholders += ", ?";
  return fmt::format("INSERT INTO {} ({}) VALUES ({})", quote_identifier(type_->name), names_of(columns_, ""),
                     placeholders);
}

std::string LandmarkLayout::update() const {
  std::vector<std::string> sets;
  for (std::size_t i = 1; i < columns_.size(); ++i)
    sets.push_back(fmt::format("{} = ?{}", quote_identifier(columns_[i].name), i + 1));
  return fmt::format("UPDATE {} SET {} WHERE id = ?1", quote_identifier(type_->name), fmt::join(sets, ", "));
}

std::string LandmarkLayout::select(std::string_view where) const {
  return fmt::format("SELECT {} FROM {} t {}", names_of(columns_, "t."), quote_identifier(type_->name),
                     where);
}

void LandmarkLayout::bind(sqlite::Statement& statement, std::int64_t row, const Landmark& landmark,
                          std::span<const std::byte> geometry, int before_first) const {
  int parameter = before_first;
  statement.bind(++parameter, row);
  statement.bind(++parameter, geometry);
  statement.bind(++parameter, std::string_view(landmark.uid));
  visit_values(*type_, landmark, [&]<class Value>(const Value& value) {
    if constexpr (std::is_same_v<Value, AttributeValue>)
      bind_attribute(statement, ++parameter, value);
    else
      statement.bind(++parameter, value);
  });
}

std::vector<double> LandmarkLayout::numbers(const Landmark& landmark) const {
  std::vector<double> numbers(kFirst, std::nan(""));
  numbers.reserve(columns_.size());
  visit_values(*type_, landmark, [&](const auto& value) { numbers.push_back(number_of(value)); });
  return numbers;
}

Landmark LandmarkLayout::read(const sqlite::Statement& row) const {
  Landmark landmark;
  landmark.uid = uid(row);
  landmark.type = id_;
  landmark.position.xyz = point_of(geometry(row)).value_or(Eigen::Vector3d::Constant(std::nan("")));

  const int common = kFirst + 3 * static_cast<int>(type_->features.size());
  landmark.quality.seen = static_cast<int>(row.integer(common));
  landmark.quality.visible = static_cast<int>(row.integer(common + 1));
  landmark.confidence = row.real(common + 4);
  landmark.covariance(0, 0) = row.real(common + 5);
  landmark.covariance(1, 1) = row.real(common + 6);
  landmark.covariance(0, 1) = landmark.covariance(1, 0) = row.real(common + 7);
  landmark.covariance(2, 2) = row.real(common + 8);
  landmark.observations = static_cast<int>(row.integer(common + 9));

  landmark.features.resize(type_->features.size());
  landmark.quality.feature_confidences.resize(type_->features.size());
  for (std::size_t i = 0; i < type_->features.size(); ++i) {
    const int column = kFirst + 3 * static_cast<int>(i);
    landmark.quality.feature_confidences[i] = row.optional_real(column + 2);
    if (row.null(column)) continue;
    const auto deviation = row.optional_real(column + 1);
    landmark.features[i] = {row.real(column), deviation ? *deviation * *deviation : 0,
                            deviation ? landmark.observations : 1};
  }
  for (std::size_t i = 0; i < type_->attributes.size(); ++i)
    landmark.attributes.push_back(
        read_attribute(row, common + 10 + static_cast<int>(i), type_->attributes[i].kind));
  return landmark;
}

}  // namespace waymark::geodb
