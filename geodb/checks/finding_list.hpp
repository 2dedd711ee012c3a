// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>
#include "geodb/validate_map.hpp"
namespace waymark::geodb {

/// Collects findings: the first hundred of each code and table, and the number of the others.
class FindingList {
 public:
  void add(std::string code, std::string table, std::optional<std::int64_t> row, std::string text);
  std::vector<Finding> take();

 private:
  std::vector<Finding> findings_;
  std::map<std::pair<std::string, std::string>, std::int64_t> count_;  ///< by code and table
};

}  // namespace waymark::geodb
