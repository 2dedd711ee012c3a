// SPDX-License-Identifier: Apache-2.0
#include "readers.hpp"

#include <algorithm>
#include <filesystem>

#include "core/text_file.hpp"
#include "exporters/vector/track_file.hpp"
#include "importers/cameras/camera_set.hpp"
#include "importers/cameras/ground_control.hpp"
#include "importers/images/image.hpp"
#include "importers/images/list_images.hpp"
#include "importers/images/photo_metadata.hpp"
#include "importers/logs/import_log.hpp"
#include "importers/points/canopy.hpp"
#include "importers/rasters/dem.hpp"
#include "importers/stages.hpp"
#include "importers/tables/area_of_interest.hpp"
#include "importers/tables/import_mapping.hpp"
#include "importers/tables/measured_trees.hpp"
#include "importers/tables/place_names.hpp"
#include "importers/tables/stand_outlines.hpp"
#include "importers/tables/table.hpp"
#include "importers/tables/table_landmarks.hpp"
#include "localization/robot_log.hpp"
#include "map_readers.hpp"
#include "pipeline/engine/job.hpp"
#include "pipeline/engine/registry.hpp"
#include "pipeline/forest/allometry.hpp"
#include "pipeline/forest/allometry_fit.hpp"
#include "pipeline/forest/stand_volume.hpp"
#include "pipeline/vision/network_text.hpp"
#include "planning/vehicle.hpp"
#include "testbed/scenario.hpp"
#include "workflows/registries.hpp"
#include "workflows/sensor_file.hpp"

namespace waymark::test {
namespace {

namespace fs = std::filesystem;
using workflows::all_types;

std::string text_of_file(const std::string& path) {
  return read_text(path, "this file");
}

std::string folder_of_file(const std::string& path) {
  return fs::path(path).parent_path().string();
}

Window corner(const GridGeometry& grid) {
  return {0, 0, std::min<std::int64_t>(grid.columns, 64), std::min<std::int64_t>(grid.rows, 64)};
}

void read_dem(const std::string& path) {
  const auto dem = importers::import_dem({.files = {path}, .crs = "EPSG:32633"});
  dem->read(corner(dem->geometry()));
}

void read_image(const std::string& path) {
  const auto listed = importers::list_images({.files = {path}, .import = {.crs = "EPSG:32633"}});
  if (listed.images.at(0).columns == 0) throw Error(ErrorCode::input, listed.warnings.at(0), path);
}

void read_photo(const std::string& path) {
  const importers::GdalDataset picture = importers::open_raster(path);
  importers::read_photo_metadata(*picture, path);
}

void read_points(const std::string& path) {
  const auto canopy = importers::import_canopy({.las = {path}});
  canopy->read(corner(canopy->geometry()));
}

importers::CameraImport map_frame(const std::string& crs = "EPSG:32651") {
  return {.crs = crs, .camera_crs = crs, .map_from_frame = Similarity{}};
}

std::function<void(const std::string&)> camera_reader(const std::string& format,
                                                      const importers::CameraImport& import) {
  return [=](const std::string& path) { importers::import_cameras(path, format, import); };
}

void read_colmap(const std::string& path) {
  importers::import_cameras(folder_of_file(path), "colmap", map_frame());
}

void read_orientations(const std::string& path) {
  importers::CameraImport import = map_frame();
  import.interior = folder_of_file(path) + "/interior.json";
  importers::import_cameras(path, "opk", import);
}

std::function<void(const std::string&)> log_reader(const std::string& format) {
  return [=](const std::string& path) { importers::import_log(path, all_types(), {.format = format}); };
}

/// `robot`: of MRCLAM, whose datasets have several; 0: of all others.
std::function<void(const std::string&)> log_folder_reader(const std::string& format, int robot) {
  return [=](const std::string& path) {
    importers::import_log(folder_of_file(path), all_types(), {.format = format, .robot = robot});
  };
}

void read_job(const std::string& path) {
  static const pipeline::Registry stages = [] {
    pipeline::Registry made;
    importers::register_importer_stages(made);
    return made;
  }();
  pipeline::read_job(path, stages);
}

void read_table(const std::string& path) {
  importers::TableImport how;
  how.type = "rock", how.map_crs = "EPSG:32632", how.skip_bad_rows = true;
  const auto table = importers::open_table(path, importers::TableFormat::by_name, "", "rock");
  importers::import_table(*table, all_types(), how, [](Landmark&&) {});
}

constexpr const char* kInterior = R"({"waymark_cameras": 1, "frame": {"axes": "grid", "crs": "EPSG:32651"},
"cameras": {"descent": {"columns": 1024, "rows": 512, "fx": 900, "fy": 901, "cx": 511.5, "cy": 255.5}},
"images": []})";
constexpr const char* kOdmCameras = R"({"v2 a": {"projection_type": "brown", "width": 2048, "height": 1365,
"focal_x": 0.77, "focal_y": 0.77, "c_x": 0, "c_y": 0, "k1": 0, "k2": 0, "p1": 0, "p2": 0, "k3": 0}})";
constexpr const char* kColmapCameras = "1 OPENCV 800 600 700 701 400 300 0.01 -0.02 0.001 0.002\n";
constexpr const char* kColmapImages = "1 0.1 0.9 0.2 0.3 1 2 3 1 a.png\n\n";

/// Binary files of COLMAP: one camera, one image.
std::string colmap_bytes(bool cameras) {
  std::string bytes(cameras ? 56 : 72, '\0');
  const auto put = [&](std::size_t at, auto value) {
    bytes.replace(at, sizeof value, std::string(reinterpret_cast<const char*>(&value), sizeof value));
  };
  put(0, std::uint64_t{1}), put(8, std::int32_t{1});
  if (cameras) {
    put(16, std::uint64_t{800}), put(24, std::uint64_t{600});
    put(32, 700.0), put(40, 400.0), put(48, 300.0);
    return bytes;
  }
  put(12, 1.0), put(68, std::int32_t{1});
  return bytes + std::string("a.png\0", 6) + std::string(8, '\0');
}

std::vector<Reader> all_readers() {
  const std::string mrclam_codes = "# Subject Barcode\n1 5\n6 72\n7 27\n",
                    mrclam_truth = "10 1 2 0.5\n11 1 2 0.5\n", mrclam_steps = "10 0.1 0\n10.2 0.1 0.1\n",
                    mrclam_seen = "10.5 72 2.5 0.1\n";
  return {
      {"dem_tiff", "dem.tif", read_dem},
      {"dem_text", "dem.asc", read_dem},
      {"image", "a.png", read_image},
      {"photo", "a.tif", read_photo},
      {"las", "points.las", read_points},
      {"laz", "points.laz", read_points},
      {"copc", "points.copc.laz", read_points},
      {"cameras_waymark", "cameras.json", camera_reader("waymark", {})},
      {"cameras_opensfm", "reconstruction.json", camera_reader("opensfm", {.crs = "EPSG:32651"})},
      {"cameras_odm",
       "shots.geojson",
       camera_reader("odm_shots", {.crs = "EPSG:32632"}),
       {{"cameras.json", kOdmCameras}}},
      {"cameras_colmap", "cameras.txt", read_colmap, {{"images.txt", kColmapImages}}},
      {"cameras_colmap_images", "images.txt", read_colmap, {{"cameras.txt", kColmapCameras}}},
      {"cameras_colmap_cameras_bin", "cameras.bin", read_colmap, {{"images.bin", colmap_bytes(false)}}},
      {"cameras_colmap_images_bin", "images.bin", read_colmap, {{"cameras.bin", colmap_bytes(true)}}},
      {"cameras_bundler", "bundle.out", camera_reader("bundler", map_frame()), {{"list.txt", "a.jpg\n"}}},
      {"cameras_metashape", "cameras.xml", camera_reader("metashape", {.crs = "local"})},
      {"cameras_tsai", "a.tsai", camera_reader("tsai", map_frame())},
      {"cameras_opk", "poses.csv", read_orientations, {{"interior.json", kInterior}}},
      {"cameras_csm", "a.json", camera_reader("csm_isd", {.crs = "IAU_2015:30110"})},
      {"log_waymark", "log.jsonl", log_reader("waymark")},
      {"log_csv", "log.csv", log_reader("csv")},
      {"log_isam", "isam.txt", log_reader("isam")},
      {"log_g2o", "a.g2o", log_reader("g2o")},
      {"log_toro", "a.graph", log_reader("toro")},
      {"log_mrclam",
       "Robot1_Measurement.dat",
       log_folder_reader("mrclam", 1),
       {{"Barcodes.dat", mrclam_codes},
        {"Robot1_Odometry.dat", mrclam_steps},
        {"Robot1_Groundtruth.dat", mrclam_truth}}},
      {"log_mrclam_odometry",
       "Robot1_Odometry.dat",
       log_folder_reader("mrclam", 1),
       {{"Barcodes.dat", mrclam_codes},
        {"Robot1_Measurement.dat", mrclam_seen},
        {"Robot1_Groundtruth.dat", mrclam_truth}}},
      {"log_victoria_park",
       "LASER.txt",
       log_folder_reader("victoria-park", 0),
       {{"DRS.txt", "90 0.5 0.01\n110 0.5 0.02\n"}, {"GPS.txt", "95 -33.1 151.2\n105 -33.2 151.3\n"}}},
      {"log_carmen", "drive.log", log_reader("carmen")},
      {"rosbag2", "bag.db3", log_reader("rosbag2")},
      {"mcap", "bag.mcap", log_reader("mcap")},
      {"track", "track.csv", [](const std::string& path) { exporters::read_track_file(path); }},
      {"job", "job.json", read_job},
      {"scenario", "scenario.json",
       [](const std::string& path) { testbed::read_scenario(text_of_file(path), path); }},
      {"vehicle", "rover.json",
       [](const std::string& path) { planning::parse_vehicle(text_of_file(path), "rover", path); }},
      {"sensor", "mine.json",
       [](const std::string& path) { workflows::parse_sensor(text_of_file(path), "mine", path); }},
      {"network", "model.txt",
       [](const std::string& path) { pipeline::parse_network(text_of_file(path), "craters", path); }},
      {"stands", "stands.geojson",
       [](const std::string& path) {
         importers::read_stand_outlines(path, "", Crs::from_text("EPSG:32632"));
       }},
      {"area", "area.geojson",
       [](const std::string& path) { importers::read_area_of_interest(path, Crs::from_text("EPSG:32632")); }},
      {"table_csv", "rocks.csv", read_table},
      {"table_geojson", "rocks.geojson", read_table},
      {"mapping", "mapping.json", [](const std::string& path) { importers::read_import_mapping(path); }},
      {"allometry", "allometry.csv",
       [](const std::string& path) { pipeline::parse_allometry(text_of_file(path), path); }},
      {"volume", "volume.csv",
       [](const std::string& path) { pipeline::parse_volume(text_of_file(path), path); }},
      {"recall", "recall.csv",
       [](const std::string& path) { pipeline::parse_recall(text_of_file(path), path); }},
      {"measured_trees", "measured.csv",
       [](const std::string& path) { importers::read_measured_trees(path, {}); }},
      {"gcp_list", "gcp_list.txt", [](const std::string& path) { importers::read_gcp_list(path); }},
      {"place_names", "names.csv",
       [](const std::string& path) {
         importers::read_place_names(path, "", "", Crs::from_text("EPSG:32632"));
       }},
      {"map_bytes", "edits.bin", read_edited_map},
      {"map_sql", "edits.sql", read_altered_map},
  };
}

}  // namespace

const std::vector<Reader>& readers() {
  static const std::vector<Reader> all = all_readers();
  return all;
}

}  // namespace waymark::test
