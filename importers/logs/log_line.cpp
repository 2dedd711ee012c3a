// SPDX-License-Identifier: Apache-2.0
#include "importers/logs/log_line.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "core/error.hpp"
#include "core/json_text.hpp"

namespace waymark::importers {

using nlohmann::json;

namespace {

constexpr const char* kLineHint =
    "a log has one object per line (docs/reference/log_format.md); not a number is written null";

const json& value_of(const void* value) {
  return *static_cast<const json*>(value);
}

const json& list(const LogLine& line, const json& object, const char* key) {
  if (!line.has(key) || !object[key].is_array()) line.fail(fmt::format("\"{}\" must be a list", key));
  return object[key];
}

}  // namespace

LogLine::LogLine(const std::filesystem::path& file, std::size_t number, std::string_view text)
    : file_(file), number_(number) {
  if (const auto fault = find_json_fault(text))
    throw Error(ErrorCode::input, "this line is no JSON object: " + fault->problem,
                fmt::format("{}, line {}, column {}", file.string(), number, fault->column), kLineHint);
  const auto document = std::make_shared<const json>(json::parse(text));
  document_ = document, object_ = document.get();
  if (!document->is_object())
    throw Error(ErrorCode::input, "this line is no JSON object",
                fmt::format("{}, line {}", file.string(), number), kLineHint);
}

bool LogLine::has(const char* key) const {
  const json& object = value_of(object_);
  return object.contains(key) && !object[key].is_null();
}
bool LogLine::is_object(const char* key) const {
  return has(key) && value_of(object_)[key].is_object();
}
std::vector<std::string> LogLine::keys() const {
  std::vector<std::string> all;
  for (const auto& [key, value] : value_of(object_).items()) all.push_back(key);
  return all;
}
LogLine LogLine::part(const char* key) const {
  return {*this, &value_of(object_)[key]};
}
std::vector<LogLine> LogLine::parts(const char* key) const {
  std::vector<LogLine> all;
  for (const json& value : list(*this, value_of(object_), key)) all.push_back({*this, &value});
  return all;
}

double LogLine::number(const char* key) const {
  if (!has(key)) fail(fmt::format("has no \"{}\"", key));
  const json& value = value_of(object_)[key];
  if (!value.is_number()) fail(fmt::format("\"{}\" must be a number, is {}", key, value.dump()));
  return value;
}
double LogLine::positive(const char* key, double otherwise) const {
  const double value = number(key, otherwise);
  if (!(value > 0)) fail(fmt::format("\"{}\" must be above 0, is {}", key, value));
  return value;
}
double LogLine::not_negative(const char* key) const {
  const double value = number(key, 0);
  if (!(value >= 0)) fail(fmt::format("\"{}\" must not be below 0, is {}", key, value));
  return value;
}

double LogLine::expect_within_two_turns(const char* key, double value, const char* rule) const {
  if (!(std::abs(value) <= 4 * std::numbers::pi)) fail(fmt::format("\"{}\" is {}: {}", key, value, rule));
  return value;
}
double LogLine::angle(const char* key, std::optional<double> otherwise) const {
  return expect_within_two_turns(key, otherwise ? number(key, *otherwise) : number(key),
                                 "angles are radians");
}
double LogLine::angular_rate(const char* key) const {
  return expect_within_two_turns(key, number(key), "turns are radians per second");
}

std::vector<float> LogLine::numbers(const char* key, float otherwise) const {
  std::vector<float> all;
  for (const json& value : list(*this, value_of(object_), key))
    all.push_back(value.is_number() ? value.get<float>() : otherwise);
  return all;
}
std::string LogLine::text(const char* key) const {
  if (!has(key) || !value_of(object_)[key].is_string()) fail(fmt::format("\"{}\" must be a text", key));
  return value_of(object_)[key];
}

localization::Pose2 LogLine::pose() const {
  return {number("x"), number("y"), angle("yaw", 0)};
}
localization::Pose2 LogLine::mount() const {
  return has("mount") ? part("mount").pose() : localization::Pose2{};
}

void LogLine::fail(const std::string& problem) const {
  throw Error(ErrorCode::input, "the log " + problem, fmt::format("{}, line {}", file_.string(), number_),
              "docs/reference/log_format.md describes each record");
}

}  // namespace waymark::importers
