// SPDX-License-Identifier: Apache-2.0
#include "core/options/option_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace waymark::inline core {
namespace {

using OrderedJson = nlohmann::ordered_json;

class TableMaker final : public OptionVisitor {
 public:
  std::vector<OptionRow> rows;

 private:
  void number(std::string_view name, double& value, std::string_view unit, const Field& field) override {
    rows.push_back({std::string(name), std::string(unit), value, field});
  }
  void integer(std::string_view name, std::int64_t& value, const Field& field) override {
    add(name, value, field);
  }
  void flag(std::string_view name, bool& value, const Field& field) override { add(name, value, field); }
  void text(std::string_view name, std::string& value, const Field& field) override {
    add(name, value, field);
  }
  void texts(std::string_view name, std::vector<std::string>& value, const Field& field) override {
    add(name, value, field);
  }
  void add(std::string_view name, OptionValue value, const Field& field) {
    rows.push_back({std::string(name), "", std::move(value), field});
  }
};

OrderedJson value_as_json(const OptionValue& value) {
  return std::visit([](const auto& v) { return OrderedJson(v); }, value);
}

std::string value_as_text(const OptionValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* texts = std::get_if<std::vector<std::string>>(&value))
    return fmt::format("{}", fmt::join(*texts, ","));
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{:g}", *number);
  return value_as_json(value).dump();
}

std::string dump(const auto& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

OrderedJson option_schema(const OptionRow& row) {
  OrderedJson schema{
      {"type", json_type(row.value)}, {"description", row.field.help}, {"default", value_as_json(row.value)}};
  const OrderedJson strings =
      row.field.choices.empty() ? OrderedJson::object() : OrderedJson{{"enum", row.field.choices}};
  if (schema["type"] == "array") schema["items"] = OrderedJson{{"type", "string"}};
  (schema["type"] == "array" ? schema["items"] : schema).update(strings);
  if (!row.unit.empty()) schema["x-unit"] = row.unit;
  if (std::isfinite(row.field.min)) schema["minimum"] = row.field.min;
  if (std::isfinite(row.field.max)) schema["maximum"] = row.field.max;
  if (!row.field.affects_result) schema["x-affects-result"] = false;
  if (!row.field.formerly.empty()) schema["x-formerly"] = row.field.formerly;
  return schema;
}

}  // namespace

std::vector<OptionRow> option_table(const DescribeOptions& describe) {
  TableMaker table;
  describe(table);
  return std::move(table.rows);
}

std::string former_name_remark(const OptionRow& row) {
  return row.field.formerly.empty() ? "" : fmt::format(" (formerly {})", row.field.formerly);
}

std::string json_type(const OptionValue& value) {
  static constexpr const char* kTypes[] = {"number", "integer", "boolean", "string", "array"};
  return kTypes[value.index()];
}

std::string readable_range(const OptionRow& row) {
  const auto [low, high] = std::pair(row.field.min, row.field.max);
  const std::string unit = row.unit.empty() ? "" : " " + row.unit;
  if (std::isfinite(low) && std::isfinite(high)) return fmt::format("[{}, {}]{}", low, high, unit);
  if (std::isfinite(low)) return fmt::format("at least {}{}", low, unit);
  if (std::isfinite(high)) return fmt::format("at most {}{}", high, unit);
  return {};
}

std::string range_fault(const OptionRow& row, double number) {
  if (row.field.min <= number && number <= row.field.max) return {};  // false for NaN
  const std::string range = readable_range(row);
  const char* relation = range.empty() || range.front() == '[' ? "is outside" : "is not";
  return fmt::format("{} = {} {} {}", row.name, number, relation, range.empty() ? "the numbers" : range);
}

std::string options_as_text(const std::vector<OptionRow>& rows) {
  std::string lines;
  for (const OptionRow& row : rows)
    lines += fmt::format("{}={}  {}{}\n", row.name, value_as_text(row.value), row.field.help,
                         former_name_remark(row));
  return lines;
}

std::string options_as_json(const std::vector<OptionRow>& rows) {
  auto all = OrderedJson::object();
  for (const OptionRow& row : rows) all[row.name] = value_as_json(row.value);
  return dump(all);
}

std::string canonical_options(const std::vector<OptionRow>& rows) {
  auto canonical = nlohmann::json::object();  // sorts its keys
  for (const OptionRow& row : rows)
    if (row.field.affects_result) canonical[row.name] = nlohmann::json(value_as_json(row.value));
  return dump(canonical);
}

std::string option_schemas(const std::vector<OptionRow>& rows) {
  auto schemas = OrderedJson::object();
  for (const OptionRow& row : rows) schemas[row.name] = option_schema(row);
  return dump(schemas);
}

}  // namespace waymark::inline core
