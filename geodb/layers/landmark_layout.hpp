// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "core/landmark.hpp"
#include "geodb/sqlite/sqlite.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::geodb {

/// The table of type k (from 0) has row ids from k * kRowsPerType + 1. Ids are unique in the view over all
/// types, also after other programs have added rows.
inline constexpr std::int64_t kRowsPerType = 1'000'000'000;

/// Column of the table of a landmark type.
struct LandmarkColumn {
  std::string name, sql_type, title, description;
};

/// Table layout of a landmark type: the columns in order, and the conversion between landmarks and rows.
///   id, geom, uid; per feature <name>, <name>_sd, <name>_q; seen, visible, q_multiplicity, quality,
///   confidence, var_x, var_y, cov_xy, var_z, observations; the type's attributes.
/// Rows do not store cov_xz, cov_yz and the observations of each feature. The latter read back as those of
/// the landmark, or 1 for features without spread.
class LandmarkLayout {
 public:
  /// Throws Error{usage} if the table name is reserved or two columns have the same name.
  LandmarkLayout(const LandmarkType& type, TypeId id);

  const LandmarkType& type() const { return *type_; }
  std::span<const LandmarkColumn> columns() const { return columns_; }

  std::string create_table() const;
  std::string insert() const;                        ///< parameters as bind() fills them
  std::string update() const;                        ///< same parameters; the row's id is unchanged
  std::string select(std::string_view where) const;  ///< of table t; `where` may join and order

  /// Binds a landmark to a statement, to the parameters after `before_first`; valid until `landmark` or
  /// `geometry` changes.
  void bind(sqlite::Statement& statement, std::int64_t row, const Landmark& landmark,
            std::span<const std::byte> geometry, int before_first = 0) const;
  Landmark read(const sqlite::Statement& row) const;
  /// Returns the value of each column as bind() stores it; NaN for NULL, geometries and texts.
  std::vector<double> numbers(const Landmark& landmark) const;

  static std::int64_t row_id(const sqlite::Statement& row) { return row.integer(0); }
  static std::span<const std::byte> geometry(const sqlite::Statement& row) { return row.blob(1); }
  static std::string_view uid(const sqlite::Statement& row) { return row.text(2); }
  double feature(const sqlite::Statement& row, std::size_t index) const {
    return row.real(kFirst + 3 * static_cast<int>(index));
  }

 private:
  static constexpr int kFirst = 3;  ///< column of the first feature
  const LandmarkType* type_;
  TypeId id_;
  std::vector<LandmarkColumn> columns_;
};

}  // namespace waymark::geodb
