// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <string_view>
#include <vector>
#include "core/observation.hpp"
#include "geodb/sqlite/sqlite.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::geodb {

/// Stores observations and links the accepted ones to their landmarks.
class EvidenceWriter {
 public:
  EvidenceWriter(const sqlite::Database& database, const TypeRegistry& types);
  /// Stores an observation. `landmark` is the row of its landmark; `std::nullopt` if it is rejected.
  void add(const Observation& observation, std::optional<std::int64_t> landmark);

 private:
  const sqlite::Database* database_;
  const TypeRegistry* types_;
  sqlite::Statement insert_;
  std::vector<sqlite::Statement> link_;  ///< by type
};

/// Reads the observations that meet `where` (SQL on table o, at most one text parameter), in order of
/// storage.
std::vector<Observation> read_evidence(const sqlite::Database& database, const TypeRegistry& types,
                                       std::string_view where, std::string_view parameter = {});
/// Visits the same observations one at a time.
void visit_evidence(const sqlite::Database& database, const TypeRegistry& types, std::string_view where,
                    std::string_view parameter, const std::function<void(Observation&&)>& visit);

}  // namespace waymark::geodb
