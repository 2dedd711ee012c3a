// SPDX-License-Identifier: Apache-2.0
#include "apps/result.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/json_text.hpp"

namespace waymark::apps {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kKindNames{"text", "flag", "integer", "number", "texts", "counts", "object", "objects"};

Json as_json(const std::monostate&) {
  return nullptr;
}
Json as_json(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}
Json as_json(const ResultJson& value) {
  return Json::parse(checked_json(value.text, "result"));
}
template <class T>
Json as_json(const T& value) {
  return value;
}

bool fits(const Json& value, ResultKind kind) {
  const auto all = [&](auto test) { return std::ranges::all_of(value, test); };
  switch (kind) {
    case ResultKind::text:
      return value.is_string();
    case ResultKind::flag:
      return value.is_boolean();
    case ResultKind::integer:
      return value.is_number_integer();
    case ResultKind::number:
      return value.is_number();
    case ResultKind::texts:
      return value.is_array() && all([](const Json& one) { return one.is_string(); });
    case ResultKind::counts:
      return value.is_object() && all([](const Json& one) { return one.is_number_integer(); });
    case ResultKind::object:
      return value.is_object();
    case ResultKind::objects:
      return value.is_array() && all([](const Json& one) { return one.is_object(); });
  }
  return false;
}

}  // namespace

std::string name_of(ResultKind kind) {
  return kKindNames.at(static_cast<std::size_t>(kind));
}

ResultValue text_or_null(std::string text) {
  if (text.empty()) return {};
  return text;
}

std::string result_object(const std::vector<std::pair<std::string, ResultValue>>& values) {
  Json object = Json::object();
  for (const auto& [name, value] : values)
    object[name] = std::visit([](const auto& one) { return as_json(one); }, value);
  return object.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void print_result(std::span<const ResultKey> declared,
                  const std::vector<std::pair<std::string, ResultValue>>& values) {
  for (const auto& [name, value] : values)
    if (std::ranges::find(declared, name, &ResultKey::name) == declared.end())
      throw std::logic_error("the result has the undeclared key " + name);
  Json object = Json::object();
  for (const ResultKey& key : declared) {
    const auto found = std::ranges::find(values, key.name, &std::pair<std::string, ResultValue>::first);
    if (found == values.end()) throw std::logic_error("the result lacks the key " + key.name);
    Json value = std::visit([](const auto& one) { return as_json(one); }, found->second);
    if (!value.is_null() && !fits(value, key.kind))
      throw std::logic_error("the result has another kind of value for the key " + key.name);
    object[key.name] = std::move(value);
  }
  std::cout << object.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
}

}  // namespace waymark::apps
