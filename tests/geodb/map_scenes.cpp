// SPDX-License-Identifier: Apache-2.0
#include "tests/geodb/map_scenes.hpp"

#include <unistd.h>

#include <array>
#include <cstdio>
#include <random>

#include "core/text_file.hpp"
#include "geodb/sqlite/sqlite.hpp"
#include "tests/support/dem_art.hpp"

namespace waymark::test {
using namespace geodb;

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "waymark-test-XXXXXX").string();
  if (!::mkdtemp(name.data())) throw std::runtime_error("cannot make " + name);
  path_ = name;
}
TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

ProgramResult run_program(const std::string& command_line) {
  ProgramResult result;
  std::FILE* pipe = ::popen((command_line + " 2>&1").c_str(), "r");
  if (!pipe) throw std::runtime_error("cannot run " + command_line);
  std::array<char, 4096> part{};
  while (const std::size_t n = std::fread(part.data(), 1, part.size(), pipe))
    result.output.append(part.data(), n);
  result.exit_code = WEXITSTATUS(::pclose(pipe));
  return result;
}

LandmarkType lamp_post() {
  using Kind = AttributeSpec::Kind;
  return {.name = "lamp_post",
          .summary = "Street light",
          .features = {{"height", "m", Scale::ratio, 2, 20, "Above the ground"},
                       {"diameter", "m", Scale::ratio, 0.05, 0.6, "Of the pole"}},
          .attributes = {{"bulb", "", Kind::text, "Kind of lamp"},
                         {"fixtures", "", Kind::integer, "Lamps on it"},
                         {"height_low", "m", Kind::real, "Certified lower bound of the height"}},
          .evidence = EvidenceModel::upright,
          .body = {"diameter", 0.5},
          .identification_reach = 300,
          .identifies_itself = true,
          .drawn_as = Solid::cylinder,
          .colour = "#d0a020",
          .label_feature = "height",
          .size_feature = "height"};
}

MapContents scattered(const Scene& scene) {
  std::mt19937 random(scene.seed);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  MapContents map;
  map.crs = scene.crs.empty() ? Crs::local() : Crs::from_text(scene.crs);
  const TypeId type = map.types.add(lamp_post());
  for (int i = 0; i < scene.landmarks; ++i) {
    Landmark l;
    l.uid = "lp-" + std::to_string(i);
    l.type = type;
    l.position.xyz = {uniform(scene.min_x, scene.max_x), uniform(scene.min_y, scene.max_y), uniform(0, 100)};
    l.covariance.diagonal() << 0.25, 0.5, 1;
    l.covariance(0, 1) = l.covariance(1, 0) = 0.1;
    l.features = {{uniform(3, 15), 0.04, 4}, {}};
    if (i % 2 == 0) l.features[1] = {uniform(0.1, 0.5), 0, 1};
    l.quality = {.seen = 3, .visible = 4, .feature_confidences = {0.9, std::nullopt}};
    l.confidence = 0.8;
    l.observations = 4;
    l.attributes = {i % 3 ? AttributeValue{"sodium"} : AttributeValue{}, std::int64_t{i % 4}, 2.5};
    map.landmarks.push_back(l);
  }
  for (int i = 0; i < std::min(scene.with_evidence, scene.landmarks); ++i) {
    const Landmark& l = map.landmarks[static_cast<std::size_t>(i)];
    Observation o;
    o.type = type;
    o.landmark_uid = l.uid;
    o.source = "image_1";
    o.pixel = Eigen::Vector2d(10.5, i);
    o.position = l.position;
    o.confidence = 0.7;
    o.features = {{l.features[0].value, 0.01, 1}, {}};
    o.covariance.diagonal() << 1, 1, 4;
    map.observations.push_back(o);
  }
  if (!map.observations.empty()) {
    Observation rejected = map.observations[0];
    rejected.landmark_uid.clear();
    rejected.rejected = "height is implausible";
    map.observations.push_back(rejected);
    map.images = {{.name = "image_1",
                   .footprint = {{{scene.min_x, scene.min_y},
                                  {scene.max_x, scene.min_y},
                                  {scene.max_x, scene.max_y},
                                  {scene.min_x, scene.min_y}}},
                   .camera_json = R"({"model":"pinhole"})",
                   .taken_utc = "2026-06-01T12:00:00.000Z",
                   .sun_azimuth = Degrees{135},
                   .sun_elevation = Degrees{40},
                   .gsd = Meters{0.2}}};
  }
  map.run = example_run();
  return map;
}

RunRecord example_run() {
  return {.version = "0.1.0",
          .command_line = "waymark run job.json -o map.gpkg",
          .job_json = R"({"name":"test","stages":[]})",
          .started_utc = "2026-11-21T07:21:14.000Z",
          .report_json = R"({"stages":[]})",
          .seconds = 1.5,
          .seed = 42,
          .inputs = {{"dem & <co>.tif", 1234, std::string(64, 'a')}}};
}

DemHandle ramp_dem(const Crs& crs, std::int64_t columns, std::int64_t rows) {
  Grid<double> heights(columns, rows);
  for (std::int64_t r = 0; r < rows; ++r)
    for (std::int64_t c = 0; c < columns; ++c)
      heights(c, r) = c < 5 && r < 5 ? kNoHeight : static_cast<double>(c) + 1000.0 * static_cast<double>(r);
  return std::make_shared<MemoryDem>(std::move(heights), Georeference{crs, 400'015, 5'099'985, 30, -30});
}

std::string file_bytes(const std::filesystem::path& path) {
  return read_text(path, "the map");
}

void execute_sql(const std::filesystem::path& map, const std::string& script) {
  sqlite::Database database(map, sqlite::OpenMode::update);
  database.execute("PRAGMA foreign_keys = OFF");
  database.execute(script);
}

std::string query_text(const std::filesystem::path& map, const std::string& sql) {
  const sqlite::Database database(map, sqlite::OpenMode::read);
  sqlite::Statement row = database.prepare(sql);
  return row.step() ? std::string(row.text(0)) : "";
}

}  // namespace waymark::test
