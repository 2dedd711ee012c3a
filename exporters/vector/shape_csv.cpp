// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/shape_csv.hpp"

#include <fmt/format.h>

#include <cmath>

#include "exporters/formatting.hpp"

namespace waymark::exporters {
namespace {

std::string cell(const AttributeValue& value) {
  if (const auto* number = std::get_if<double>(&value))
    return std::isfinite(*number) ? fmt::format("{:.10g}", *number) : "";
  if (const auto* count = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *count);
  const auto* text = std::get_if<std::string>(&value);
  return text == nullptr ? "" : csv_text(*text);
}

}  // namespace

std::string layer_to_csv(const geodb::ShapeLayer& layer) {
  std::string text;
  for (const AttributeSpec& column : layer.columns) text += (text.empty() ? "" : ",") + csv_text(column.name);
  text += '\n';
  for (const geodb::Shape& row : layer.rows) {
    for (std::size_t i = 0; i < row.values.size(); ++i) text += (i == 0 ? "" : ",") + cell(row.values[i]);
    text += '\n';
  }
  return text;
}

}  // namespace waymark::exporters
