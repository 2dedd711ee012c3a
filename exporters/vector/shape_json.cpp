// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/shape_json.hpp"

#include <nlohmann/json.hpp>

namespace waymark::exporters {
namespace {

nlohmann::ordered_json member(const AttributeValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return *number;  // dumped as null if not finite
  if (const auto* count = std::get_if<std::int64_t>(&value)) return *count;
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  return nullptr;
}

}  // namespace

std::string layer_to_json(const geodb::ShapeLayer& layer) {
  auto rows = nlohmann::ordered_json::array();
  for (const geodb::Shape& row : layer.rows) {
    auto object = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < row.values.size(); ++i) object[layer.columns[i].name] = member(row.values[i]);
    rows.push_back(std::move(object));
  }
  return rows.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace waymark::exporters
