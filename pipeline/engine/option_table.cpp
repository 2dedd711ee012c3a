// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/option_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace waymark {
namespace {

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

}  // namespace

std::vector<OptionRow> option_table(const Step& step) {
  TableMaker table;
  step.show_options(table);
  return std::move(table.rows);
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

std::string canonical_options(const Step& step) {
  auto canonical = nlohmann::json::object();  // sorts its keys
  for (const OptionRow& row : option_table(step))
    if (row.field.affects_result)
      std::visit([&](const auto& value) { canonical[row.name] = value; }, row.value);
  return canonical.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace waymark
