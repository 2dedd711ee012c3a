// SPDX-License-Identifier: Apache-2.0
#include "small_map.hpp"

#include <algorithm>
#include <cstdlib>

#include "core/text_file.hpp"
#include "geodb/write_map.hpp"

namespace waymark::test {
namespace {

Landmark summit(const geodb::MapContents& map, const std::string& uid, double x, double y, double elevation,
                double prominence) {
  const LandmarkType& type = map.types[map.types.id("mountain_top")];
  Landmark landmark;
  landmark.uid = uid;
  landmark.type = map.types.id("mountain_top");
  landmark.position.xyz = {x, y, elevation};
  landmark.covariance.diagonal() << 900, 900, 25;
  landmark.features = {{elevation, 25, 2}, {prominence, 0, 1}, {1000, 0, 1}};
  landmark.attributes.resize(type.attributes.size());
  landmark.attributes[attribute_index(type, "prominence_low")] = prominence / 2;
  landmark.attributes[attribute_index(type, "isolation_low")] = 1000.0;
  landmark.attributes[attribute_index(type, "saddle_elevation")] = elevation - prominence;
  landmark.attributes[attribute_index(type, "saddle_x")] = x;
  landmark.attributes[attribute_index(type, "saddle_y")] = y;
  landmark.quality = {1, 1, {0.95, std::nullopt, std::nullopt}};
  return landmark;
}

Landmark crater(const geodb::MapContents& map, const std::string& uid, double x, double y, double radius) {
  const LandmarkType& type = map.types[map.types.id("crater")];
  Landmark landmark;
  landmark.uid = uid;
  landmark.type = map.types.id("crater");
  landmark.position.xyz = {x, y, 0};
  landmark.features.resize(type.features.size());
  landmark.features[feature_index(type, "radius")] = {radius, 0, 1};
  landmark.quality = {1, 2, std::vector<std::optional<double>>(type.features.size())};
  return landmark;
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "waymark-exporters-XXXXXX").string();
  path_ = ::mkdtemp(pattern.data());
}

TemporaryFolder::~TemporaryFolder() {
  std::filesystem::remove_all(path_);
}

geodb::MapContents three_summits(const std::string& crs, double x, double y, double spacing) {
  geodb::MapContents map;
  register_landmark_types(map.types);
  map.crs = Crs::from_text(crs);
  map.landmarks = {summit(map, "mt-one", x, y, 3000, 3000), summit(map, "mt-two", x + spacing, y, 2000, 500),
                   summit(map, "mt-three", x, y + spacing, 1000, 20)};
  map.run.version = "0.1.0";
  map.run.command_line = "waymark peaks dem.tif -o map.gpkg";
  map.run.started_utc = "2026-11-21T07:21:14Z";
  map.run.seconds = 1.5;
  map.run.job_json = R"({"stages": [{"stage": "load_dem"}]})";
  map.run.report_json = R"({"stages": [
    {"stage": "find_mountain_tops", "units": 4, "made": 3, "reused": 1, "in": 120, "out": 3,
     "rejected": {"prominence below 20 m": 117}, "seconds": 0.25, "warnings": ["a seam <disagrees>"]}],
    "failures": [{"unit": "find_mountain_tops/tile_3", "message": "the file is damaged"}]})";
  map.run.inputs = {{"dem.tif", 1234567, std::string(64, 'a')}};
  return map;
}

void write_small_map(const std::filesystem::path& path) {
  geodb::write_map(path, three_summits("EPSG:4326", -70.01, -32.65, 0.1));
}

void write_mars_map(const std::filesystem::path& path) {
  geodb::write_map(path, three_summits("IAU_2015:49900", 226.2, 18.65, 1));
}

void write_two_type_map(const std::filesystem::path& path) {
  geodb::MapContents map = three_summits("EPSG:4326", -70.01, -32.65, 0.1);
  map.landmarks.push_back(crater(map, "cr-one", -70, -32.6, 800));
  map.landmarks.push_back(crater(map, "cr-two", -70.05, -32.6, 3000));
  geodb::write_map(path, map);
}

void write_crater_map(const std::filesystem::path& path, const std::string& crs, double x, double y,
                      double spacing) {
  geodb::MapContents map = three_summits(crs, x, y, spacing);
  map.landmarks = {crater(map, "cr-one", x, y, 8000), crater(map, "cr-two", x + spacing, y + spacing, 8000)};
  geodb::write_map(path, map);
}

std::string content_of(const std::filesystem::path& file) {
  return read_text(file, "the output");
}

std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace waymark::test
