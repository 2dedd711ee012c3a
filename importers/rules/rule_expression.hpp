// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>
#include "importers/tables/table_expression.hpp"
namespace waymark::importers {

/// Arithmetic on the tags of an element, as TableExpression on columns: `circumference/pi`. Names that an
/// element lacks have no value.
class RuleExpression {
 public:
  /// Throws Error{usage} with the position of a fault.
  explicit RuleExpression(const std::string& text);

  /// Returns the value; NaN if a tag is missing or no length or number, or the result is not finite.
  double value(const std::map<std::string, std::string>& tags) const;
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::vector<std::string> names_;
  TableExpression expression_;
};

/// Parses a number, or a length with its unit as people write them into tags: "12", "12.5 m", "3,5m",
/// "40 cm", "16'", "5 ft". Returns metres; `std::nullopt` for other text.
std::optional<double> parse_tag_number(const std::string& text);

}  // namespace waymark::importers
