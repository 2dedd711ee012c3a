// SPDX-License-Identifier: Apache-2.0
#include "importers/tables/table_landmarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "core/error.hpp"
#include "core/landmark.hpp"
#include "importers/tables/plausible_landmark.hpp"
#include "importers/tables/table.hpp"
#include "importers/tables/table_columns.hpp"
#include "importers/tables/table_positions.hpp"
#include "landmarks/semantic_map.hpp"

namespace waymark::importers {
namespace {

/// Types of the rows of a table: one type for all, or by the words of a column.
class RowTypes {
 public:
  RowTypes(const TableHeader& table, const TypeRegistry& types, const TableImport& how) : types_(&types) {
    for (const auto& [word, type] : how.type_words) words_[word] = types.id(type);
    if (!how.type_column.empty())
      column_ = column_index(table.columns, how.type_column);
    else if (std::ranges::count(table.columns, "type") == 1)
      column_ = column_index(table.columns, "type");
    if (!how.type.empty())
      only_ = types.id(how.type);
    else if (how.type_column.empty() && types.find(table.layer) != nullptr)
      only_ = types.id(table.layer);
    else if (!column_)
      throw Error(ErrorCode::usage, "the table does not name the type of its rows", table.path,
                  "pass --type, e.g. --type crater, or a --mapping; `waymark types` lists them");
  }

  std::vector<std::string> names() const {
    if (only_) return {(*types_)[*only_].name};
    if (words_.empty()) return types_->names();
    std::vector<std::string> named;
    for (TypeId id = 0; id < types_->size(); ++id)
      if (std::ranges::any_of(words_, [&](const auto& word) { return word.second == id; }))
        named.push_back((*types_)[id].name);
    return named;
  }

  /// Returns the index of the column that holds the types, if there is one.
  std::optional<std::size_t> column() const { return column_; }

  /// Returns the type of a row; `std::nullopt` for another or unknown type.
  std::optional<TypeId> of(const TableRow& row) const {
    const std::string said = column_ ? row.cells[*column_] : "";
    std::optional<TypeId> type;
    if (const auto word = words_.find(said); word != words_.end())
      type = word->second;
    else if (words_.empty() && types_->find(said) != nullptr)
      type = types_->id(said);
    if (!only_) return type;
    if (!words_.empty()) return type == only_ ? type : std::nullopt;
    // Other words in a column `type`, such as "standard", are ignored.
    return type && *type != *only_ ? std::nullopt : only_;
  }

 private:
  const TypeRegistry* types_;
  std::map<std::string, TypeId> words_;
  std::optional<std::size_t> column_;
  std::optional<TypeId> only_;
};

/// Reads the cells of a row by the targets they are bound to.
class Cells {
 public:
  Cells(const TableSource& table, const ColumnBindings& bindings) : table_(table), bindings_(bindings) {}

  double real(const TableRow& row, std::string_view target) const {
    const auto found = bindings_.find(target);
    return found == bindings_.end() ? std::nan("") : found->second.value(row, table_);
  }
  int count(const TableRow& row, std::string_view target) const {
    const double value = real(row, target);
    return value >= 0 && value < 1e9 ? static_cast<int>(std::lround(value)) : 1;
  }
  std::string word(const TableRow& row, std::string_view target) const {
    const auto found = bindings_.find(target);
    return found == bindings_.end() ? "" : found->second.word(row);
  }
  AttributeValue attribute(const TableRow& row, const AttributeSpec& spec) const {
    if (spec.kind == AttributeSpec::Kind::text) {
      const std::string text = word(row, spec.name);
      return text.empty() ? AttributeValue() : AttributeValue(text);
    }
    const double value = real(row, spec.name);
    if (std::isnan(value)) return {};
    if (spec.kind == AttributeSpec::Kind::integer) return static_cast<std::int64_t>(std::llround(value));
    return value;
  }

 private:
  const TableSource& table_;
  const ColumnBindings& bindings_;
};

double zero_if_nan(double value) {
  return std::isnan(value) ? 0 : value;
}

void read_covariance(const Cells& cells, const TableRow& row, Eigen::Matrix3d& covariance) {
  const double both = cells.real(row, "position_sd"), unknown = std::nan("");
  const auto variance = [&](const char* as_variance, const char* as_sd, double otherwise) {
    const double given = cells.real(row, as_variance), sd = cells.real(row, as_sd);
    return !std::isnan(given) ? given : !std::isnan(sd) ? sd * std::abs(sd) : otherwise * std::abs(otherwise);
  };
  covariance(0, 0) = variance("var_x", "x_sd", both);
  covariance(1, 1) = variance("var_y", "y_sd", both);
  covariance(2, 2) = variance("var_z", "z_sd", unknown);
  const bool known = !std::isnan(covariance(0, 0)) && !std::isnan(covariance(1, 1));
  if (!known) covariance(0, 0) = covariance(1, 1) = unknown;  // half a covariance is none
  covariance(0, 1) = covariance(1, 0) = known ? zero_if_nan(cells.real(row, "cov_xy")) : unknown;
}

void read_features(const Cells& cells, const TableRow& row, const LandmarkType& type, Landmark& landmark) {
  landmark.features.resize(type.features.size());
  landmark.quality.feature_confidences.resize(type.features.size());
  for (std::size_t i = 0; i < type.features.size(); ++i) {
    const FeatureSpec& feature = type.features[i];
    const double value = cells.real(row, feature.name), sd = cells.real(row, feature.name + "_sd");
    if (std::isnan(value)) continue;
    const bool spread = !std::isnan(sd);
    landmark.features[i] = {value, spread ? sd * std::abs(sd) : 0, spread ? landmark.observations : 1};
    landmark.quality.feature_confidences[i] =
        spread ? spread_confidence(landmark.features[i], feature.scale, feature.reference) : std::nullopt;
  }
}

Landmark read_landmark(const Cells& cells, const TableRow& row, const LandmarkType& type, TypeId id) {
  Landmark landmark;
  landmark.type = id;
  landmark.uid = cells.word(row, "uid");
  landmark.position.xyz = {cells.real(row, "x"), cells.real(row, "y"), zero_if_nan(cells.real(row, "z"))};
  const double confidence = cells.real(row, "confidence");
  landmark.confidence = std::isnan(confidence) ? 1 : confidence;
  landmark.observations = std::max(1, cells.count(row, "observations"));
  landmark.quality.seen = cells.count(row, "seen");
  landmark.quality.visible = std::max(landmark.quality.seen, cells.count(row, "visible"));
  read_covariance(cells, row, landmark.covariance);
  read_features(cells, row, type, landmark);
  for (const AttributeSpec& attribute : type.attributes)
    landmark.attributes.push_back(cells.attribute(row, attribute));
  return landmark;
}

/// Counts rejections and stores those with a position as observations.
class Rejections {
 public:
  Rejections(ImportedTable& into, const TableSource& table) : into_(into), table_(table) {}

  void add(const TableRow& row, const std::string& reason) {
    ++into_.rejected_by_reason[reason];
    if (into_.first_rejection.empty())
      into_.first_rejection = fmt::format("{}: {}", table_.row_location(row), reason);
  }

  void add(const TableRow& row, const Landmark& landmark, const std::string& reason) {
    add(row, reason);
    Observation seen;
    seen.type = landmark.type;
    seen.source = table_.row_location(row);
    seen.position = landmark.position;
    seen.features = landmark.features;
    seen.confidence = landmark.confidence > 0 && landmark.confidence <= 1 ? landmark.confidence : 1;
    seen.covariance = is_possible_covariance(landmark.covariance) ? landmark.covariance
                                                                  : Eigen::Matrix3d::Constant(std::nan(""));
    for (FeatureValue& feature : seen.features) feature.variance = std::max(0.0, feature.variance);
    seen.rejected = reason;
    into_.rejected.push_back(std::move(seen));
  }

 private:
  ImportedTable& into_;
  const TableSource& table_;
};

/// Binds the columns; errors name the table.
ColumnBindings bindings_of(const TableHeader& header, const TypeRegistry& types,
                           const std::vector<std::string>& chosen, const std::string& columns) {
  try {
    return bind_columns(columns, header, types, chosen);
  } catch (const Error& error) {
    if (!error.where().empty()) throw;
    throw Error(error.code(), error.problem(), header.path, error.hint());
  }
}

/// Returns the columns that no binding uses, in the order of the table; without those of geometries.
std::vector<std::string> unused_columns(const TableHeader& header, std::optional<std::size_t> of_types,
                                        const std::vector<const ColumnBindings*>& all) {
  std::set<std::size_t> used;
  if (of_types) used.insert(*of_types);
  for (const ColumnBindings* bindings : all)
    for (const auto& [target, expression] : *bindings) expression.add_columns(used);
  std::vector<std::string> unused;
  for (std::size_t i = 0; i < header.columns.size(); ++i)
    if (!used.contains(i) && !header.columns[i].starts_with("geom_")) unused.push_back(header.columns[i]);
  return unused;
}

void refuse_empty_result(const ImportedTable& result, const std::string& path) {
  if (result.landmarks > 0 || result.rows == 0) return;
  std::string reasons;
  for (const auto& [reason, count] : result.rejected_by_reason)
    reasons += fmt::format("{}{} {}", reasons.empty() ? "" : ", ", count, reason);
  if (const auto outside = result.rejected_by_reason.find(kOutsideArea);
      outside != result.rejected_by_reason.end() && outside->second == result.rows)
    throw Error(ErrorCode::input,
                fmt::format("none of the {} rows lies in the area of interest", result.rows), path,
                "check the CRSs of the table and of the area");
  throw Error(ErrorCode::input, fmt::format("none of the {} rows is plausible: {}", result.rows, reasons),
              path,
              "lengths are metres and angles radians: give the unit, e.g. --columns radius=diam_km*500; "
              "`waymark types` shows the ranges");
}

}  // namespace

ImportedTable import_table(TableSource& table, const TypeRegistry& types, const TableImport& how,
                           const std::function<void(Landmark&&)>& take) {
  const TableHeader& header = table.header();
  const RowTypes row_types(header, types, how);
  ImportedTable result;
  result.types = row_types.names();
  const ColumnBindings bindings = bindings_of(header, types, result.types, how.columns);
  for (const auto& [target, expression] : bindings)
    result.bindings.push_back(
        target == expression.text() ? target : fmt::format("{} = {}", target, expression.text()));
  std::map<TypeId, ColumnBindings> bindings_of_type;
  for (const auto& [type, columns] : how.columns_of_type) {
    const TypeId id = types.id(type);
    if (std::ranges::find(result.types, type) == result.types.end()) continue;
    for (const ColumnAssignment& one : column_assignments(columns))
      result.bindings.push_back(fmt::format("{}: {} = {}", type, one.target, one.expression));
    bindings_of_type.emplace(id, bindings_of(header, types, result.types, how.columns + "," + columns));
  }
  std::vector<const ColumnBindings*> all{&bindings};
  for (const auto& [type, own] : bindings_of_type) all.push_back(&own);
  result.unused = unused_columns(header, row_types.column(), all);
  TablePositions positions(header, how.table_crs, how.map_crs, names_imply_degrees(bindings));
  positions.keep_inside(how.aoi);
  result.crs = positions.map_crs();

  Rejections rejections(result, table);
  TableRow row;
  for (;;) {
    ++result.rows;
    try {
      if (!table.next(row)) {
        --result.rows;
        break;
      }
      const auto type = row_types.of(row);
      if (!type) {
        rejections.add(row, "of another type");
        continue;
      }
      const auto own = bindings_of_type.find(*type);
      const Cells cells(table, own == bindings_of_type.end() ? bindings : own->second);
      Landmark landmark = read_landmark(cells, row, types[*type], *type);
      const std::vector<FeatureSpec>& specs = types[*type].features;
      if (const std::string nowhere = positions.transform_to_map(landmark, specs, AngleReference::table);
          !nowhere.empty()) {
        rejections.add(row, nowhere);
      } else if (const std::string reason = find_implausibility(types[*type], landmark); !reason.empty()) {
        rejections.add(row, landmark, reason);
      } else {
        ++result.landmarks;
        take(std::move(landmark));
      }
    } catch (const Error& error) {
      if (!how.skip_bad_rows || error.code() != ErrorCode::input) throw;
      rejections.add(row, "cannot be read");
    }
  }
  result.warnings = positions.warnings();
  refuse_empty_result(result, header.path);
  return result;
}

}  // namespace waymark::importers
