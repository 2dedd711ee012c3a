// SPDX-License-Identifier: Apache-2.0
#include "geodb/geopackage/provenance.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/escape_markup.hpp"
#include "core/json_text.hpp"
#include "core/source_date.hpp"
#include "geodb/geopackage/geometry_blob.hpp"

namespace waymark::geodb {
namespace {

using nlohmann::ordered_json;

std::string inputs_json(const std::vector<InputFile>& inputs) {
  ordered_json list = ordered_json::array();
  for (const auto& [path, bytes, sha256] : inputs)
    list.push_back({{"path", path}, {"bytes", bytes}, {"sha256", sha256}});
  return list.dump();
}

std::vector<InputFile> inputs_from(std::string_view text) {
  std::vector<InputFile> inputs;
  const auto list = ordered_json::parse(json_or_empty(text), nullptr, /*allow_exceptions=*/false);
  const auto text_at = [](const ordered_json& file, const char* key) {
    const auto found = file.find(key);
    return found != file.end() && found->is_string() ? found->get<std::string>() : std::string();
  };
  for (const auto& file : list) {
    if (!file.is_object()) continue;
    const auto bytes = file.find("bytes");
    inputs.push_back({text_at(file, "path"),
                      bytes != file.end() && bytes->is_number_unsigned() ? bytes->get<std::uint64_t>() : 0,
                      text_at(file, "sha256")});
  }
  return inputs;
}

std::string json_or(const std::string& text, const char* empty) {
  return text.empty() ? empty : text;
}

template <class Unit>
std::optional<double> number(const std::optional<Quantity<Unit>>& quantity) {
  return quantity ? std::optional(quantity->value) : std::nullopt;
}

template <class Unit>
std::optional<Quantity<Unit>> quantity(const std::optional<double>& value) {
  return value ? std::optional(Quantity<Unit>{*value}) : std::nullopt;
}

}  // namespace

void write_run(const sqlite::Database& database, const RunRecord& run) {
  sqlite::Statement insert = database.prepare(
      "INSERT INTO run (version, command_line, job, inputs, started, seed, seconds, report)"
      "  VALUES (?, ?, ?, ?, ?, ?, ?, ?)");
  const std::string job = json_or(run.job_json, "{}"), report = json_or(run.report_json, "{}");
  const std::string inputs = inputs_json(run.inputs), started = time_stamp(run.started_utc);
  insert.bind_all(run.version, run.command_line, job, inputs, started, run.seed, run.seconds, report);
  insert.run();
}

std::vector<RunRecord> read_runs(const sqlite::Database& database) {
  std::vector<RunRecord> runs;
  sqlite::Statement row = database.prepare(
      "SELECT version, command_line, job, inputs, started, seed, seconds, report FROM run ORDER BY id");
  while (row.step())
    runs.push_back({.version = std::string(row.text(0)),
                    .command_line = std::string(row.text(1)),
                    .job_json = std::string(row.text(2)),
                    .started_utc = std::string(row.text(4)),
                    .report_json = std::string(row.text(7)),
                    .seconds = row.real(6),
                    .seed = row.integer(5),
                    .inputs = inputs_from(row.text(3))});
  return runs;
}

void write_image(const sqlite::Database& database, const ImageRecord& image, std::int32_t srs_id) {
  sqlite::Statement insert = database.prepare(
      "INSERT INTO image (geom, name, camera, taken, sun_azimuth, sun_elevation, gsd) VALUES (?, ?, ?, ?, ?, "
      "?, ?)");
  const std::vector<std::byte> footprint = polygons_blob(image.footprint, srs_id);
  const std::string camera = json_or(image.camera_json, "{}"), taken = time_stamp(image.taken_utc);
  insert.bind_all(std::span<const std::byte>(footprint), image.name, camera, taken, number(image.sun_azimuth),
                  number(image.sun_elevation), number(image.gsd));
  if (image.footprint.empty()) insert.bind(1, nullptr);
  if (image.taken_utc.empty()) insert.bind(4, nullptr);
  insert.run();
}

std::vector<ImageRecord> read_images(const sqlite::Database& database) {
  std::vector<ImageRecord> images;
  sqlite::Statement row = database.prepare(
      "SELECT geom, name, camera, taken, sun_azimuth, sun_elevation, gsd FROM image ORDER BY id");
  while (row.step())
    images.push_back({.name = std::string(row.text(1)),
                      .footprint = polygons_of(row.blob(0)),
                      .camera_json = std::string(row.text(2)),
                      .taken_utc = std::string(row.text(3)),
                      .sun_azimuth = quantity<DegreesUnit>(row.optional_real(4)),
                      .sun_elevation = quantity<DegreesUnit>(row.optional_real(5)),
                      .gsd = quantity<MetersUnit>(row.optional_real(6))});
  return images;
}

void write_metadata(const sqlite::Database& database, const RunRecord& run, std::string_view changed) {
  std::string document =
      "<metadata xmlns:dc=\"http://purl.org/dc/elements/1.1/\" xmlns:dcterms=\"http://purl.org/dc/terms/\">\n"
      "  <dc:title>Semantic map of landmarks</dc:title>\n";
  document += fmt::format("  <dc:creator>Waymark {}</dc:creator>\n", escape_markup(run.version));
  document += fmt::format("  <dcterms:created>{}</dcterms:created>\n", changed);
  document += fmt::format("  <dcterms:provenance>{}</dcterms:provenance>\n", escape_markup(run.command_line));
  for (const auto& input : run.inputs)
    document +=
        fmt::format("  <dc:source>{} sha256:{}</dc:source>\n", escape_markup(input.path), input.sha256);
  document += "</metadata>\n";
  sqlite::Statement insert = database.prepare(
      "INSERT INTO gpkg_metadata VALUES (1, 'dataset', 'http://purl.org/dc/terms/', 'text/xml', ?)");
  insert.bind(1, document);
  insert.run();
  sqlite::Statement reference = database.prepare(
      "INSERT INTO gpkg_metadata_reference VALUES ('geopackage', NULL, NULL, NULL, ?, 1, NULL)");
  reference.bind(1, changed);
  reference.run();
}

std::string time_stamp(std::string_view iso_8601) {
  constexpr std::string_view shape = "0000-00-00T00:00:00";
  const std::string unknown = "1970-01-01T00:00:00.000Z";
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (iso_8601.size() < shape.size()) return unknown;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    const char c = iso_8601[i];
    const bool fits = shape[i] == '0' ? is_digit(c) : c == shape[i] || (shape[i] == 'T' && c == ' ');
    if (!fits) return unknown;
  }
  std::string_view rest = iso_8601.substr(shape.size());
  std::string fraction = ".";
  if (rest.starts_with('.'))
    for (rest.remove_prefix(1); !rest.empty() && is_digit(rest.front()); rest.remove_prefix(1))
      fraction += rest.front();
  if (!rest.empty() && rest != "Z" && rest != "+00:00") return unknown;
  fraction.resize(4, '0');
  std::string stamp(iso_8601.substr(0, shape.size()));
  stamp[10] = 'T';
  return stamp + fraction + "Z";
}

std::string time_stamp_now() {
  std::chrono::system_clock::time_point now = std::chrono::system_clock::now();
  if (const auto fixed = source_date()) now = *fixed;
  return time_stamp(
      fmt::format("{:%Y-%m-%dT%H:%M:%S}Z", fmt::gmtime(std::chrono::system_clock::to_time_t(now))));
}

}  // namespace waymark::geodb
