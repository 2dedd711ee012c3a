// SPDX-License-Identifier: Apache-2.0
#include "geodb/layers/evidence.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/json_text.hpp"
#include "geodb/sqlite/sql_text.hpp"

namespace waymark::geodb {
namespace {

using nlohmann::json;

std::string features_json(const LandmarkType& type, const FeatureSet& features) {
  json object = json::object();
  for (std::size_t i = 0; i < type.features.size() && i < features.size(); ++i) {
    if (!features[i].known()) continue;
    object[type.features[i].name] = features[i].value;
    if (features[i].variance > 0) object[type.features[i].name + "_sd"] = std::sqrt(features[i].variance);
  }
  return object.dump();
}

FeatureSet features_from(const LandmarkType& type, std::string_view text) {
  FeatureSet features(type.features.size());
  const json object = json::parse(json_or_empty(text), nullptr, /*allow_exceptions=*/false);
  if (!object.is_object()) return features;
  const auto number = [&](const std::string& key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
  };
  for (std::size_t i = 0; i < features.size(); ++i) {
    const auto value = number(type.features[i].name);
    if (!value) continue;
    const double deviation = number(type.features[i].name + "_sd").value_or(0);
    features[i] = {*value, deviation * deviation, 1};
  }
  return features;
}

std::optional<std::string_view> null_if_empty(std::string_view text) {
  return text.empty() ? std::nullopt : std::optional(text);
}

}  // namespace

EvidenceWriter::EvidenceWriter(const sqlite::Database& database, const TypeRegistry& types)
    : database_(&database),
      types_(&types),
      insert_(
          database.prepare("INSERT INTO observation (type, uid, source, pixel_x, pixel_y, x, y, z, var_x, "
                           "var_y, cov_xy, var_z, weight,"
                           "  features, rejected) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")) {
  for (const auto& type : types)
    link_.push_back(
        database.prepare("INSERT INTO " + quote_identifier(type.name + "_observation") + " VALUES (?, ?)"));
}

void EvidenceWriter::add(const Observation& o, std::optional<std::int64_t> landmark) {
  const LandmarkType& type = (*types_)[o.type];
  const std::string features = features_json(type, o.features);
  const auto pixel = [&](int axis) { return o.pixel ? std::optional((*o.pixel)[axis]) : std::nullopt; };
  const Eigen::Vector3d& at = o.position.xyz;
  insert_.bind_all(type.name, null_if_empty(o.landmark_uid), o.source, pixel(0), pixel(1), at.x(), at.y(),
                   at.z(), o.covariance(0, 0), o.covariance(1, 1), o.covariance(0, 1), o.covariance(2, 2),
                   o.confidence, features, null_if_empty(o.rejected));
  insert_.run();
  if (!landmark) return;
  link_[o.type].bind_all(*landmark, database_->last_id());
  link_[o.type].run();
}

void visit_evidence(const sqlite::Database& database, const TypeRegistry& types, std::string_view where,
                    std::string_view parameter, const std::function<void(Observation&&)>& visit) {
  sqlite::Statement row = database.prepare(
      "SELECT type, uid, source, pixel_x, pixel_y, x, y, z, var_x, var_y, cov_xy, var_z, weight, features, "
      "rejected"
      "  FROM observation o " +
      std::string(where) + " ORDER BY o.id");
  if (!parameter.empty()) row.bind(1, parameter);
  while (row.step()) {
    Observation o;
    if (!types.find(row.text(0)))
      throw Error(
          ErrorCode::input,
          "an observation is of the type '" + std::string(row.text(0)) + "', which the map does not declare",
          "table observation", "`waymark validate` lists the errors of the map");
    o.type = types.id(row.text(0));
    o.landmark_uid = row.text(1);
    o.source = row.text(2);
    if (!row.null(3)) o.pixel = Eigen::Vector2d(row.real(3), row.real(4));
    o.position.xyz = {row.real(5), row.real(6), row.real(7)};
    o.covariance(0, 0) = row.real(8);
    o.covariance(1, 1) = row.real(9);
    o.covariance(0, 1) = o.covariance(1, 0) = row.real(10);
    o.covariance(2, 2) = row.real(11);
    o.confidence = row.real(12);
    o.features = features_from(types[o.type], row.text(13));
    o.rejected = row.text(14);
    visit(std::move(o));
  }
}

std::vector<Observation> read_evidence(const sqlite::Database& database, const TypeRegistry& types,
                                       std::string_view where, std::string_view parameter) {
  std::vector<Observation> all;
  visit_evidence(database, types, where, parameter,
                 [&](Observation&& observation) { all.push_back(std::move(observation)); });
  return all;
}

}  // namespace waymark::geodb
