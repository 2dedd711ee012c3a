// SPDX-License-Identifier: Apache-2.0
#include "importers/json_value.hpp"

#include <cpl_vsi.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/json_text.hpp"
#include "core/text_file.hpp"
#include "importers/gdal_session.hpp"

namespace waymark::importers {
namespace {

using Json = nlohmann::json;

const Json& json(const void* value) {
  return *static_cast<const Json*>(value);
}

}  // namespace

struct JsonValue::Document {
  std::string path;
  Json root;
};

JsonValue JsonValue::from_file(const std::string& path, const std::vector<std::string>& skipped) {
  return from_text(read_vsi_text(path), path, skipped);
}

JsonValue JsonValue::from_text(const std::string& content, const std::string& path,
                               const std::vector<std::string>& skipped) {
  checked_json(content, path);
  auto document = std::make_shared<Document>();
  document->path = path;
  const auto keep = [&](int, Json::parse_event_t event, Json& key) {
    return event != Json::parse_event_t::key ||
           std::ranges::find(skipped, key.get<std::string>()) == skipped.end();
  };
  document->root = skipped.empty() ? Json::parse(content) : Json::parse(content, keep);
  const Json* root = &document->root;
  return {std::move(document), root, ""};
}

bool JsonValue::is_object() const {
  return json(value_).is_object();
}
bool JsonValue::is_array() const {
  return json(value_).is_array();
}
bool JsonValue::is_text() const {
  return json(value_).is_string();
}
bool JsonValue::is_number() const {
  return json(value_).is_number();
}

void JsonValue::refuse(const std::string& problem, const std::string& hint) const {
  throw Error(ErrorCode::input, problem, document_->path + (location_.empty() ? "" : ", at " + location_),
              hint);
}

bool JsonValue::has(const std::string& key) const {
  const Json& j = json(value_);
  return j.is_object() && j.contains(key) && !j[key].is_null();
}

JsonValue JsonValue::operator[](const std::string& key) const {
  if (!is_object()) refuse(fmt::format("this must be an object with a member '{}'", key));
  if (!has(key))
    refuse(fmt::format("'{}' is missing", key), "add it; docs/reference/camera_file.md describes it");
  return {document_, &json(value_)[key], location_ + "/" + key};
}

JsonValue JsonValue::operator[](std::size_t index) const {
  if (!is_array() || index >= size())
    refuse(fmt::format("this must be an array of at least {} values", index + 1));
  return {document_, &json(value_)[index], fmt::format("{}/{}", location_, index)};
}

std::size_t JsonValue::size() const {
  return json(value_).size();
}

std::vector<std::string> JsonValue::keys() const {
  std::vector<std::string> all;
  if (!is_object()) refuse("this must be an object");
  for (const auto& [key, value] : json(value_).items()) all.push_back(key);
  return all;
}

double JsonValue::number() const {
  const double value = is_number() ? json(value_).get<double>() : std::numeric_limits<double>::quiet_NaN();
  if (!std::isfinite(value))
    refuse(fmt::format("this must be a number, is {}", json(value_).dump().substr(0, 40)));
  return value;
}

double JsonValue::number(const std::string& key, double otherwise) const {
  return has(key) ? (*this)[key].number() : otherwise;
}

std::int64_t JsonValue::integer() const {
  const double value = number();
  if (value != std::floor(value) || std::abs(value) > 1e15)
    refuse(fmt::format("this must be a whole number, is {}", value));
  return static_cast<std::int64_t>(value);
}

std::string JsonValue::text() const {
  if (!is_text()) refuse(fmt::format("this must be text, is {}", json(value_).dump().substr(0, 40)));
  return json(value_).get<std::string>();
}

std::vector<double> JsonValue::numbers() const {
  if (!is_array()) refuse("this must be an array of numbers");
  std::vector<double> all;
  for (std::size_t i = 0; i < size(); ++i) all.push_back((*this)[i].number());
  return all;
}

Eigen::Vector3d JsonValue::vector3() const {
  const auto all = numbers();
  if (all.size() != 3) refuse(fmt::format("this must be 3 numbers, there are {}", all.size()));
  return {all[0], all[1], all[2]};
}

Eigen::Matrix3d JsonValue::matrix3() const {
  Eigen::Matrix3d matrix;
  if (!is_array() || (size() != 3 && size() != 9)) refuse("this must be 3 rows of 3 numbers");
  for (std::size_t i = 0; i < 9; ++i)
    matrix(static_cast<int>(i / 3), static_cast<int>(i % 3)) =
        size() == 9 ? (*this)[i].number() : (*this)[i / 3].vector3()[static_cast<int>(i % 3)];
  return matrix;
}

void JsonValue::expect_only(const std::vector<std::string>& known) const {
  for (const std::string& key : keys()) {
    if (std::ranges::find(known, key) != known.end()) continue;
    const std::string near = nearest_name(key, known);
    refuse(fmt::format("there is no field '{}'{}", key,
                       near.empty() ? "" : fmt::format("; did you mean '{}'?", near)),
           fmt::format("fields: {}", fmt::join(known, ", ")));
  }
}

std::string read_vsi_head(const std::string& path, std::size_t bytes) {
  const GdalListener gdal;
  VSILFILE* file = VSIFOpenL(path.c_str(), "rb");
  if (!file)
    throw Error(ErrorCode::input, "the file cannot be read", path, "check that it exists and may be read");
  std::string content(std::min<std::size_t>(bytes, std::size_t{1} << 20), '\0');
  std::size_t got = 0;
  while (const std::size_t count = VSIFReadL(content.data() + got, 1, content.size() - got, file)) {
    got += count;
    if (got == content.size() && got < bytes) content.resize(std::min(bytes, 2 * got));
    if (got == bytes) break;
  }
  VSIFCloseL(file);
  content.resize(got);
  return content;
}

std::string read_vsi_text(const std::string& path) {
  std::error_code unknown;
  if (std::filesystem::is_character_file(path, unknown)) return read_text(path, "the file");
  return read_vsi_head(path, std::numeric_limits<std::size_t>::max() / 4);
}

}  // namespace waymark::importers
