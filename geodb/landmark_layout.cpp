// SPDX-License-Identifier: Apache-2.0
#include "geodb/landmark_layout.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <set>

#include "core/error.hpp"
#include "core/quality.hpp"
#include "geodb/attribute_column.hpp"
#include "geodb/geometry_blob.hpp"
#include "geodb/sql_text.hpp"
#include "landmarks/sensor_profile.hpp"

namespace waymark {
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

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : name + " (" + unit + ")";
}

const std::vector<LandmarkColumn>& common_columns() {
  static const std::vector<LandmarkColumn> columns = {
      {"seen", "INTEGER NOT NULL", "seen", "Images or surveys that detected it"},
      {"visible", "INTEGER NOT NULL", "visible", "Images or surveys that could have"},
      {"q_multiplicity", "DOUBLE", "q_#", "Multiplicity confidence seen / visible, 0 to 1"},
      {"quality", "DOUBLE", "quality", "Landmark quality with equal feature weights, 0 to 1"},
      {"confidence", "DOUBLE NOT NULL", "confidence", "Probability that the landmark exists, 0 to 1"},
      {"var_x", "DOUBLE", "east variance (m2)", "Variance of the position to the east; NULL: unknown"},
      {"var_y", "DOUBLE", "north variance (m2)", "Variance of the position to the north; NULL: unknown"},
      {"cov_xy", "DOUBLE", "east-north covariance (m2)", "Covariance of east and north"},
      {"var_z", "DOUBLE", "height variance (m2)", "Variance of the height; NULL: the height is unknown"},
      {"observations", "INTEGER NOT NULL", "observations", "Observations merged into it"},
  };
  return columns;
}

std::string names_of(std::span<const LandmarkColumn> columns, std::string_view before) {
  std::vector<std::string> names;
  for (const auto& column : columns) names.push_back(std::string(before) + sql_name(column.name));
  return fmt::format("{}", fmt::join(names, ", "));
}

std::optional<double> spread(const FeatureValue& feature) {
  if (feature.observations < 2 && !(feature.variance > 0)) return std::nullopt;
  return std::sqrt(feature.variance);
}

}  // namespace

LandmarkLayout::LandmarkLayout(const LandmarkType& type, TypeId id) : type_(&type), id_(id) {
  check_name(type.name);
  columns_ = {{"id", "INTEGER PRIMARY KEY", "id", "Row; unique over all landmark types of the map"},
              {"geom", "POINT", "position", "Position and height in the map's CRS"},
              {"uid", "TEXT NOT NULL", "uid", "Name that stays the same over runs"}};
  for (const auto& f : type.features) {
    columns_.push_back({f.name, "DOUBLE", with_unit(f.name, f.unit), f.summary});
    columns_.push_back(
        {f.name + "_sd", "DOUBLE", with_unit(f.name + " spread", f.unit),
         "Standard deviation of the observations; NULL where one observation gives no spread"});
    columns_.push_back({f.name + "_q", "DOUBLE", "q of " + f.name,
                        "Variance confidence, 0 to 1; NULL where one observation gives no spread"});
  }
  columns_.insert(columns_.end(), common_columns().begin(), common_columns().end());
  for (const auto& a : type.attributes)
    columns_.push_back({a.name, sql_type(a.kind), with_unit(a.name, a.unit), a.summary});

  std::set<std::string_view> names;
  for (const auto& column : columns_)
    if (!names.insert(column.name).second)
      throw Error(ErrorCode::usage,
                  fmt::format("landmark type '{}' would have two columns named '{}'", type.name, column.name),
                  "", "rename the feature or attribute");
}

std::string LandmarkLayout::create_table() const {
  std::vector<std::string> lines;
  for (const auto& column : columns_) lines.push_back("  " + sql_name(column.name) + " " + column.sql_type);
  return fmt::format("CREATE TABLE {} (\n{}\n)", sql_name(type_->name), fmt::join(lines, ",\n"));
}

std::string LandmarkLayout::insert() const {
  std::string places = "?";
  for (std::size_t i = 1; i < columns_.size(); ++i) places += ", ?";
  return fmt::format("INSERT INTO {} ({}) VALUES ({})", sql_name(type_->name), names_of(columns_, ""),
                     places);
}

std::string LandmarkLayout::update() const {
  std::vector<std::string> sets;
  for (std::size_t i = 1; i < columns_.size(); ++i)
    sets.push_back(fmt::format("{} = ?{}", sql_name(columns_[i].name), i + 1));
  return fmt::format("UPDATE {} SET {} WHERE id = ?1", sql_name(type_->name), fmt::join(sets, ", "));
}

std::string LandmarkLayout::select(std::string_view where) const {
  return fmt::format("SELECT {} FROM {} t {}", names_of(columns_, "t."), sql_name(type_->name), where);
}

void LandmarkLayout::bind(sqlite::Statement& statement, std::int64_t row, const Landmark& landmark,
                          std::span<const std::byte> geometry) const {
  statement.bind_all(row, geometry, landmark.uid);
  int parameter = kFirst;
  for (std::size_t i = 0; i < type_->features.size(); ++i) {
    const bool known = i < landmark.features.size() && landmark.features[i].known();
    const FeatureValue value = known ? landmark.features[i] : FeatureValue{};
    const auto& confidences = landmark.quality.of_feature;
    statement.bind(++parameter, value.value);
    statement.bind(++parameter, spread(value));
    statement.bind(++parameter, known && i < confidences.size() ? confidences[i] : std::nullopt);
  }
  const auto& [seen, visible, of_feature] = landmark.quality;
  const auto& covariance = landmark.covariance;
  statement.bind(++parameter, seen);
  statement.bind(++parameter, visible);
  statement.bind(++parameter, multiplicity_confidence(seen, visible));
  statement.bind(++parameter, quality_of(*type_, landmark));
  for (const double value :
       {landmark.confidence, covariance(0, 0), covariance(1, 1), covariance(0, 1), covariance(2, 2)})
    statement.bind(++parameter, value);
  statement.bind(++parameter, landmark.observations);
  static const AttributeValue none;  // texts are bound in place, so no temporary will do
  for (std::size_t i = 0; i < type_->attributes.size(); ++i)
    bind_attribute(statement, ++parameter, i < landmark.attributes.size() ? landmark.attributes[i] : none);
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
  landmark.quality.of_feature.resize(type_->features.size());
  for (std::size_t i = 0; i < type_->features.size(); ++i) {
    const int column = kFirst + 3 * static_cast<int>(i);
    landmark.quality.of_feature[i] = row.optional_real(column + 2);
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

}  // namespace waymark
