// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "core/landmark.hpp"
#include "geodb/sqlite.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark {

/// Rows of the table of type number k (from 0) have ids from k * kRowsPerType + 1, so that an id is unique in
/// the view over all types, also after other programs have added rows.
inline constexpr std::int64_t kRowsPerType = 1'000'000'000;

/// One column of a type's table.
struct LandmarkColumn {
  std::string name, sql_type, title, description;
};

/// The table of a landmark type: its columns in order, and how a landmark becomes a row and back.
///   id, geom, uid; per feature <name>, <name>_sd, <name>_q; seen, visible, q_multiplicity, quality,
///   confidence, var_x, var_y, cov_xy, var_z, observations; the type's attributes.
/// A row does not keep cov_xz and cov_yz, nor the count of observations of each feature: it reads back as
/// that of the landmark, or 1 where there is no spread.
class LandmarkLayout {
 public:
  /// Throws Error{usage} where a table or two columns would share a name.
  LandmarkLayout(const LandmarkType& type, TypeId id);

  const LandmarkType& type() const { return *type_; }
  TypeId type_id() const { return id_; }
  std::span<const LandmarkColumn> columns() const { return columns_; }

  std::string create_table() const;
  std::string insert() const;                        ///< parameters as bind() fills them
  std::string update() const;                        ///< the same, and the row's id is kept
  std::string select(std::string_view where) const;  ///< of table t; `where` may join and order

  /// Valid until `landmark` changes.
  void bind(sqlite::Statement& statement, std::int64_t row, const Landmark& landmark,
            std::span<const std::byte> geometry) const;
  Landmark read(const sqlite::Statement& row) const;

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

}  // namespace waymark
