// SPDX-License-Identifier: Apache-2.0
// Every reader of files, given hundreds of damaged files: it succeeds, or throws an Error for people.
#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <functional>

#include "core/error.hpp"
#include "core/printable.hpp"
#include "core/text_file.hpp"
#include "exporters/las_file.hpp"
#include "exporters/raster/raster_file.hpp"
#include "exporters/vector/track_file.hpp"
#include "geodb/map_store.hpp"
#include "geodb/shape_layer.hpp"
#include "geodb/validate_map.hpp"
#include "geodb/write_map.hpp"
#include "importers/cameras/camera_set.hpp"
#include "importers/images/list_images.hpp"
#include "importers/logs/import_log.hpp"
#include "importers/points/canopy.hpp"
#include "importers/rasters/dem.hpp"
#include "importers/tables/stand_outlines.hpp"
#include "importers/tables/table.hpp"
#include "importers/tables/table_landmarks.hpp"
#include "localization/robot_log.hpp"
#include "pipeline/forest/allometry.hpp"
#include "pipeline/forest/stand_volume.hpp"
#include "testbed/scenario.hpp"
#include "tests/workflows/mutations.hpp"
#include "workflows/evaluation/evaluate.hpp"
#include "workflows/mapping/make_map.hpp"
#include "workflows/registries.hpp"
#include "workflows/training/fit_allometry.hpp"

namespace waymark::test {
using namespace workflows;
namespace {

namespace fs = std::filesystem;

// A screen of a terminal, generously.
constexpr std::size_t kMaxLines = 30, kMaxBytes = 3500;
// Slower than any mutation of such small files should be by far, also on a busy machine.
constexpr double kMaxSeconds = 5;

class MutatedFiles : public ::testing::Test {
 protected:
  MutatedFiles() {
    std::string name = (fs::temp_directory_path() / "waymark-mutated-XXXXXX").string();
    if (!::mkdtemp(name.data())) throw std::runtime_error("cannot make " + name);
    folder_ = name;
    ::alarm(300);  // ends a reader that hangs
  }
  ~MutatedFiles() override {
    ::alarm(0);
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  std::string write(const std::string& name, std::string_view content) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return (folder_ / name).string();
  }

  /// Reads the sound file, then `count` mutations of it.
  void check(const std::string& name, const std::string& content, Content kind, std::size_t count,
             const std::function<void(const std::string& path)>& read) const {
    const std::string path = write(name, content);
    ASSERT_NO_THROW(read(path)) << "the sound file";
    std::size_t refused = 0, faults = 0;
    for (std::size_t n = 0; n < count && faults < 5; ++n) {
      write(name, mutate(content, kind, n));
      const auto began = std::chrono::steady_clock::now();
      const std::string fault = fault_of(path, read, refused);
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
      EXPECT_LT(seconds, kMaxSeconds) << name << ", mutation " << n;
      if (fault.empty()) continue;
      ++faults;
      ADD_FAILURE() << name << ", mutation " << n << ": " << fault;
    }
    EXPECT_GT(refused, 0u) << "no mutation was noticed";
    write(name, content);
  }

  static std::string fault_of(const std::string& path, const std::function<void(const std::string&)>& read,
                              std::size_t& refused) {
    try {
      read(path);
      return {};
    } catch (const Error& error) {
      ++refused;
      return fault_of_message(error, path);
    } catch (const std::exception& error) {
      return std::string("a foreign exception: ") + error.what();
    }
  }

  static std::string fault_of_message(const Error& error, const std::string& path) {
    const std::string said = error.what();
    if (error.code() != ErrorCode::input && error.code() != ErrorCode::usage)
      return "an error of another kind: " + said;
    if (error.problem().empty()) return "no problem is named: " + said;
    if (said.size() > kMaxBytes || std::ranges::count(said, '\n') > std::ptrdiff_t{kMaxLines})
      return "more than a screen: " + said;
    if (said != printable(said, said.size())) return "control characters: " + printable(said, kMaxBytes);
    for (const char* internal :
         {"json.exception", "std::", "basic_string", "vector::", "stoi", "stod", "map::at"})
      if (said.find(internal) != said.npos) return std::string("a message of a library: ") + said;
    // The readers of a data set name the part of it.
    if (said.find(fs::path(path).parent_path().filename().string()) == said.npos)
      return "the file is not named: " + said;
    return {};
  }

  fs::path folder_;
};

/// Returns 24 x 20 cells of a slope with bumps.
Grid<float> bumpy_slope() {
  Grid<float> cells(24, 20);
  for (std::int64_t y = 0; y < cells.rows(); ++y)
    for (std::int64_t x = 0; x < cells.columns(); ++x)
      cells(x, y) = static_cast<float>(100 + x + 10 * ((x * 7 + y * 5) % 11 == 0));
  return cells;
}

std::string dem_bytes(const fs::path& folder) {
  const fs::path file = folder / "made.tif";
  exporters::write_raster(file, bumpy_slope(), {Crs::from_text("EPSG:32633"), 500000, 5000000, 2, -2});
  return read_text(file, "the DEM");
}

TEST_F(MutatedFiles, OfDems) {
  check("dem.tif", dem_bytes(folder_), Content::binary, 200, [](const std::string& path) {
    const auto dem = importers::import_dem({.files = {path}});
    const GridGeometry& grid = dem->geometry();
    dem->read({0, 0, std::min<std::int64_t>(grid.columns, 64), std::min<std::int64_t>(grid.rows, 64)});
  });
}

TEST_F(MutatedFiles, OfTextRasters) {
  check("dem.asc",
        "ncols 4\nnrows 3\nxllcorner 500000\nyllcorner 5000000\ncellsize 10\nNODATA_value -9999\n"
        "1 2 3 4\n5 6 7 8\n9 10 -9999 12\n",
        Content::text, 150, [](const std::string& path) {
          const auto dem = importers::import_dem({.files = {path}, .crs = "EPSG:32633"});
          const GridGeometry& grid = dem->geometry();
          dem->read({0, 0, std::min<std::int64_t>(grid.columns, 64), std::min<std::int64_t>(grid.rows, 64)});
        });
}

TEST_F(MutatedFiles, OfLaserPoints) {
  {
    exporters::LasFile las(folder_ / "made.las", Crs::from_text("EPSG:32633"), 500000, 5000000);
    for (int i = 0; i < 400; ++i)
      las.add({.x = 500000.0 + i % 20,
               .y = 5000000.0 + i / 20,
               .z = 100 + (i % 7 == 0) * 12.0,
               .kind = static_cast<std::uint8_t>(i % 7 ? 2 : 5)});
    las.close();
  }
  check(
      "points.las", read_text(folder_ / "made.las", "the points"), Content::binary, 150,
      [](const std::string& path) {
        const auto canopy = importers::import_canopy({.las = {path}});
        const GridGeometry& grid = canopy->geometry();
        canopy->read({0, 0, std::min<std::int64_t>(grid.columns, 64), std::min<std::int64_t>(grid.rows, 64)});
      });
}

importers::CameraImport map_frame() {
  return {.crs = "EPSG:32651", .camera_crs = "EPSG:32651", .map_from_frame = Similarity{}};
}

constexpr const char* kCameras = R"({
"waymark_cameras": 1,
"frame": {"axes": "grid", "crs": "EPSG:32651"},
"sun": {"azimuth": 120, "elevation": 35},
"cameras": {"descent": {"columns": 1024, "rows": 512, "fx": 900, "fy": 901, "cx": 511.5, "cy": 255.5,
            "distortion": [-0.1, 0.02, 0.0002, -0.0001, 0]}},
"images": [{"name": "a.png", "camera": "descent", "centre": [292710, 2731048, 186],
            "rotation": [[1, 0, 0], [0, -1, 0], [0, 0, -1]], "rotation_sd": 0.05, "position_sd": 0.3,
            "taken_utc": "2021-02-18T20:51:06Z"},
           {"name": "b.png", "camera": "descent"}]}
)";

TEST_F(MutatedFiles, OfCameras) {
  check("cameras.json", kCameras, Content::text, 200,
        [](const std::string& path) { importers::import_cameras(path, "", {}); });
}

TEST_F(MutatedFiles, OfOpenSfm) {
  check("reconstruction.json",
        R"([{"cameras": {"v2": {"projection_type": "brown", "width": 1368, "height": 912,
"focal_x": 0.666, "focal_y": 0.666, "c_x": -0.0015, "c_y": 0.0047, "k1": -0.26, "k2": 0.1, "p1": 0.0007,
"p2": 0.0003, "k3": -0.026}},
"shots": {"a.jpg": {"rotation": [2.6377, 0.0466, -0.0111], "translation": [-74.06, -17.73, 222.57],
"camera": "v2", "orientation": 1, "capture_time": 1554980828.0}},
"points": {"1": {"coordinates": [1, 2, 3]}},
"reference_lla": {"latitude": 24.68, "longitude": 120.95, "altitude": 0.0}}]
)",
        Content::text, 150,
        [](const std::string& path) { importers::import_cameras(path, "", {.crs = "EPSG:32651"}); });
}

TEST_F(MutatedFiles, OfOpenDroneMap) {
  write("cameras.json",
        R"({"v2 a": {"projection_type": "brown", "width": 2048, "height": 1365, "focal_x": 0.77,
"focal_y": 0.77, "c_x": 0, "c_y": 0, "k1": 0, "k2": 0, "p1": 0, "p2": 0, "k3": 0}})");
  check("shots.geojson", R"({"type": "FeatureCollection", "features": [{"type": "Feature",
"properties": {"filename": "DJI_0075.JPG", "camera": "v2 a", "focal": 0.7869, "width": 2048, "height": 1365,
"capture_time": 1751203124.0, "translation": [442726.48489705415, 5444260.74771845, 164.74563456039826],
"rotation": [-3.123689868839532, -0.29161158497842005, 0.02538492108870502]},
"geometry": {"type": "Point", "coordinates": [8.214619092077715, 49.14849807121841, 164.745]}}]}
)",
        Content::text, 150,
        [](const std::string& path) { importers::import_cameras(path, "odm_shots", {.crs = "EPSG:32632"}); });
}

TEST_F(MutatedFiles, OfColmap) {
  const auto folder = [](const std::string& path) { return fs::path(path).parent_path().string(); };
  const auto read = [&](const std::string& path) {
    importers::import_cameras(folder(path), "colmap", map_frame());
  };
  const std::string cameras =
      "# Camera list with one line of data per camera:\n1 OPENCV 800 600 700 701 400 300 "
      "0.01 -0.02 0.001 0.002\n";
  const std::string images =
      "# Image list with two lines of data per image:\n1 0.1 0.9 0.2 0.3 1 2 3 1 a b.png\n"
      "100 200 -1 300 400 5\n2 0.1 0.9 0.2 0.3 1 2 3 1 c.png\n\n";
  write("images.txt", images);
  check("cameras.txt", cameras, Content::text, 100, read);
  check("images.txt", images, Content::text, 100, read);
}

TEST_F(MutatedFiles, OfColmapBytes) {
  std::string cameras(8 + 4 + 4 + 8 + 8 + 3 * 8, '\0'), images(8 + 4 + 7 * 8 + 4, '\0');
  const auto put = [](std::string& bytes, std::size_t at, auto value) {
    bytes.replace(at, sizeof value, std::string(reinterpret_cast<const char*>(&value), sizeof value));
  };
  put(cameras, 0, std::uint64_t{1}), put(cameras, 8, std::int32_t{1});
  put(cameras, 16, std::uint64_t{800}), put(cameras, 24, std::uint64_t{600});
  put(cameras, 32, 700.0), put(cameras, 40, 400.0), put(cameras, 48, 300.0);
  put(images, 0, std::uint64_t{1}), put(images, 8, std::int32_t{1}), put(images, 12, 1.0);
  put(images, 68, std::int32_t{1});
  images += std::string("a.png\0", 6) + std::string(8, '\0');
  const auto read = [](const std::string& path) {
    importers::import_cameras(fs::path(path).parent_path().string(), "colmap", map_frame());
  };
  write("images.bin", images);
  check("cameras.bin", cameras, Content::binary, 100, read);
  check("images.bin", images, Content::binary, 100, read);
}

TEST_F(MutatedFiles, OfBundler) {
  write("list.txt", "a.jpg\n");
  check("bundle.out",
        "# Bundle file v0.3\n1 1\n700 0.01 0.001\n1 0 0\n0 1 0\n0 0 1\n1 2 3\n"
        "0 0 0\n255 0 0\n1 0 0 1 1\n",
        Content::text, 100,
        [](const std::string& path) { importers::import_cameras(path, "bundler", map_frame()); });
}

TEST_F(MutatedFiles, OfMetashape) {
  check("cameras.xml", R"(<?xml version="1.0" encoding="UTF-8"?>
<document version="1.5.0"><chunk label="Chunk 1"><sensors next_id="1"><sensor id="0" label="cam" type="frame">
<resolution width="4000" height="3000"/><calibration type="frame" class="adjusted">
<resolution width="4000" height="3000"/><f>3600</f><cx>10</cx><cy>-5</cy><k1>-0.01</k1><p1>0.0001</p1>
</calibration></sensor></sensors><cameras next_id="1" next_group_id="0">
<camera id="0" sensor_id="0" label="a"><transform>1 0 0 1 0 1 0 2 0 0 1 3 0 0 0 1</transform></camera></cameras>
<reference>LOCAL_CS["Local",LOCAL_DATUM["Local",0],UNIT["metre",1]]</reference>
<transform><rotation>1 0 0 0 1 0 0 0 1</rotation><translation>10 20 30</translation><scale>1</scale></transform>
</chunk></document>
)",
        Content::text, 150,
        [](const std::string& path) { importers::import_cameras(path, "metashape", {.crs = "local"}); });
}

TEST_F(MutatedFiles, OfAmesCameras) {
  check(
      "a.tsai",
      "VERSION_4\nPINHOLE\nfu = 620.8\nfv = 622.3\ncu = 526.1\ncv = 374.3\nu_direction = 1 0 0\n"
      "v_direction = 0 1 0\nw_direction = 0 0 1\nC = 292710 2731048 186\nR = 1 0 0 0 -1 0 0 0 -1\npitch = 1\n"
      "TSAI\nk1 = -0.33\nk2 = 0.12\np1 = -0.0004\np2 = 0.001\n",
      Content::text, 150,
      [](const std::string& path) { importers::import_cameras(path, "tsai", map_frame()); });
}

TEST_F(MutatedFiles, OfExteriorOrientations) {
  const std::string cameras = write("interior.json", kCameras);
  check("poses.csv",
        "image,x,y,z,omega,phi,kappa,camera\na.png,292710.2,2731048.8,186.4,28.8,0.94,1.782,descent\n"
        "b.png,292746.2,2731093.5,186.6,-2.7,-30.1,-93.7,descent\n",
        Content::text, 100, [&](const std::string& path) {
          importers::CameraImport import = map_frame();
          import.interior = cameras;
          importers::import_cameras(path, "opk", import);
        });
}

constexpr const char* kLog = R"({"kind":"header","version":1,"frame":"map","start":{"x":1,"y":2,"yaw":0.5}}
{"kind":"truth","t":0,"x":1,"y":2,"yaw":0.5}
{"kind":"odometry","t":0,"v":1,"omega":0.1}
{"kind":"sightings","t":0.5,"mount":{"x":0.3,"y":0},"items":[{"type":"rock","range":4,"bearing":-0.2,"landmark":"rk-1","features":{"radius":{"value":0.4,"sd":0.05}}},{"bearing":1}]}
{"kind":"laser","t":0.6,"first_angle":-1.57,"angle_step":0.1,"ranges":[1,null,3]}
{"kind":"depth","t":0.65,"columns":2,"rows":1,"focal":9,"depths":[1,2]}
{"kind":"gnss","t":0.7,"x":1,"y":2,"sd":3}
{"kind":"car","t":0.8,"v":1,"steering":0.1}
{"kind":"step","t":0.9,"dx":1,"dy":0,"dyaw":0.1}
)";

TEST_F(MutatedFiles, OfRobotLogs) {
  check("log.jsonl", kLog, Content::text, 250,
        [](const std::string& path) { importers::import_log(path, all_types(), {.format = "waymark"}); });
}

TEST_F(MutatedFiles, OfPoseGraphs) {
  const auto read = [](const char* format) {
    return
        [format](const std::string& path) { importers::import_log(path, all_types(), {.format = format}); };
  };
  check("isam.txt",
        "ODOMETRY 0 1 1 0 0.1 10 0 0 20 0 40\nODOMETRY 1 2 1 0 0.1 10 0 0 20 0 40\n"
        "LANDMARK 0 3 2 1 5 0 4\nLANDMARK 2 3 0.1 1 5 0 4\n",
        Content::text, 100, read("isam"));
  check("a.g2o",
        "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0.1\nVERTEX_XY 3 2 1\nFIX 0\n"
        "EDGE_SE2 0 1 1 0 0.1 100 0 0 400 0 1600\nEDGE_SE2_XY 0 3 2 1 25 0 16\n",
        Content::text, 100, read("g2o"));
  check("a.graph",
        "VERTEX2 0 0 0 0\nVERTEX2 1 1 0 0.1\nEDGE2 0 1 1 0 0.1 100 0 400 1600 0 0\n"
        "LANDMARK 0 3 2 1 25 0 16\n",
        Content::text, 100, read("toro"));
}

TEST_F(MutatedFiles, OfMrclam) {
  const auto read = [](const std::string& path) {
    importers::import_log(fs::path(path).parent_path(), all_types(), {.format = "mrclam", .robot = 1});
  };
  const std::string codes = "# Subject Barcode\n1 5\n6 72\n7 27\n";
  const std::string seen = "# Time Subject range bearing\n10.5 72 2.5 0.1\n10.6 27 3.5 -0.1\n";
  write("Robot1_Odometry.dat", "10 0.1 0\n10.2 0.1 0.1\n10.7 0.1 0\n");
  write("Robot1_Measurement.dat", seen);
  write("Robot1_Groundtruth.dat", "10 1 2 0.5\n11 1 2 0.5\n");
  check("Barcodes.dat", codes, Content::text, 100, read);
  check("Robot1_Measurement.dat", seen, Content::text, 100, read);
  check("Robot1_Odometry.dat", "10 0.1 0\n10.2 0.1 0.1\n10.7 0.1 0\n", Content::text, 100, read);
}

TEST_F(MutatedFiles, OfLaserLogs) {
  std::string scan = "100";
  for (int i = 0; i < 361; ++i) scan += " " + std::to_string(8 + i % 3);
  write("DRS.txt", "90 0.5 0.01\n110 0.5 0.02\n");
  write("GPS.txt", "95 -33.1 151.2\n105 -33.2 151.3\n");
  check("LASER.txt", scan + "\n" + scan + "\n", Content::text, 100, [](const std::string& path) {
    importers::import_log(fs::path(path).parent_path(), all_types(), {.format = "victoria-park"});
  });
}

TEST_F(MutatedFiles, OfTracks) {
  localization::Track track;
  for (int i = 0; i < 6; ++i)
    track.rows.push_back({.t = 0.5 * i, .at = {{0.5 * i, 1, 0.1}, Eigen::Matrix3d::Identity()}});
  exporters::write_track_csv(folder_ / "made.csv", track);
  const std::string log = write("truth.jsonl", R"({"kind":"truth","t":0,"x":0,"y":1,"yaw":0.1}
{"kind":"truth","t":3,"x":3,"y":1,"yaw":0.1}
)");
  check("track.csv", read_text(folder_ / "made.csv", "the track"), Content::text, 150,
        [&](const std::string& path) {
          evaluate(TrackEvaluation{.track = path, .truth = log, .max_gap = 10});
        });
}

TEST_F(MutatedFiles, OfJobs) {
  write("dem.tif", dem_bytes(folder_));
  check("job.json", R"({
"name": "Mountain tops",
"stages": [
  {"stage": "load_dem", "files": ["dem.tif"], "nodata": "unknown", "height_scale": 1.5, "tile_cells": 4096},
  {"stage": "find_mountain_tops", "min_prominence": 30},
  {"stage": "join_mountain_tops"},
  {"stage": "measure_isolation"},
  {"stage": "map_mountain_tops", "min_isolation": 10}
]
}
)",
        Content::text, 100, [&](const std::string& path) { make_map(load_job(path), {.check = true}); });
}

TEST_F(MutatedFiles, OfScenarios) {
  check("scenario.json",
        read_text(WAYMARK_SOURCE_DIR "/sample_data/mars_mission/scenario.json", "the scenario"),
        Content::text, 150,
        [](const std::string& path) { testbed::read_scenario(read_text(path, "the scenario"), path); });
}

TEST_F(MutatedFiles, OfStands) {
  check("stands.geojson", R"({"type": "FeatureCollection", "name": "stands",
"crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32632"}}, "features": [
{"type": "Feature", "properties": {"stand": "a", "species": "spruce"}, "geometry": {"type": "Polygon",
"coordinates": [[[440000, 5400000], [440100, 5400000], [440100, 5400100], [440000, 5400100], [440000, 5400000]]]}},
{"type": "Feature", "properties": {"stand": "b", "species": null}, "geometry": {"type": "MultiPolygon",
"coordinates": [[[[440200, 5400000], [440300, 5400000], [440300, 5400100], [440200, 5400000]]]]}}]}
)",
        Content::text, 150, [](const std::string& path) {
          importers::read_stand_outlines(path, "", Crs::from_text("EPSG:32632"));
        });
}

importers::TableImport rock_table(const char* crs, bool skip_bad_rows) {
  importers::TableImport how;
  how.type = "rock";
  how.map_crs = crs;
  how.skip_bad_rows = skip_bad_rows;
  return how;
}

TEST_F(MutatedFiles, OfTables) {
  check("rocks.csv", "x,y,z,radius,uid,confidence\n1,2,0,0.5,a,0.9\n3,4,0,0.6,b,0.8\n5,6,0,0.7,c,1\n",
        Content::text, 150, [](const std::string& path) {
          const auto table = importers::open_table(path, importers::TableFormat::by_name, "", "rock");
          importers::import_table(*table, all_types(), rock_table("local", true), [](Landmark&&) {});
        });
  check("rocks.geojson", R"({"type": "FeatureCollection", "features": [
{"type": "Feature", "properties": {"radius": 0.5}, "geometry": {"type": "Point", "coordinates": [8.1, 49.1, 100]}},
{"type": "Feature", "properties": {"radius": 0.7}, "geometry": {"type": "Point", "coordinates": [8.2, 49.2]}}]}
)",
        Content::text, 100, [](const std::string& path) {
          const auto table = importers::open_table(path, importers::TableFormat::by_name, "", "rock");
          importers::import_table(*table, all_types(), rock_table("EPSG:32632", false), [](Landmark&&) {});
        });
}

TEST_F(MutatedFiles, OfForestTables) {
  const auto text = [](const std::string& path) { return read_text(path, "this table"); };
  check("allometry.csv",
        "species,form,a,b,sigma,trees,rmse_cm\nall,height,1.2,0.9,0.2,100,3.5\n"
        "spruce,height_crown,0.5,0.8,0.2,50,3\n",
        Content::text, 100, [&](const std::string& path) { pipeline::parse_allometry(text(path), path); });
  check("volume.csv", "species,form_factor,form_factor_sd,mass_per_volume\nall,0.47,0.04,500\n",
        Content::text, 100, [&](const std::string& path) { pipeline::parse_volume(text(path), path); });
  check("recall.csv", "height_from,recall,sd\n0,0.3,0.1\n10,0.7,0.1\n20,0.9,0.05\n", Content::text, 100,
        [&](const std::string& path) { pipeline::parse_recall(text(path), path); });
  std::string measured = "species,plot,height,dbh,crown_diameter\n";
  for (int i = 0; i < 30; ++i)
    measured += "spruce,p" + std::to_string(i % 3) + "," + std::to_string(10 + i) + "," +
                std::to_string(12 + i) + ",4\n";
  check("measured.csv", measured, Content::text, 100,
        [](const std::string& path) { fit_allometry(AllometryRequest{.input = path}); });
}

/// Reads everything that commands read of a map.
void read_map(const std::string& path) {
  const geodb::MapStore map = geodb::MapStore::open(path);
  for (const std::string& type : map.types().names()) map.visit(type, [](Landmark&&) {});
  map.query({.nearest = geodb::MapQuery::NearestK{0, 0, 3}});
  map.visit_observations([](Observation&&) {});
  map.images();
  map.runs();
  for (const std::string& layer : geodb::shape_layers(path)) geodb::read_shape_layer(path, layer);
}

std::string map_bytes(const fs::path& folder) {
  geodb::MapContents contents;
  contents.types = all_types();
  const TypeId rock = contents.types.id("rock");
  const LandmarkType& type = contents.types[rock];
  for (int i = 0; i < 20; ++i) {
    Landmark l;
    l.uid = "rk-" + std::to_string(i);
    l.type = rock;
    l.position.xyz << i % 5, i / 5, 0;
    l.features.resize(type.features.size());
    l.attributes.resize(type.attributes.size());
    l.quality = {1, 1, std::vector<std::optional<double>>(type.features.size())};
    contents.landmarks.push_back(l);
    Observation o;
    o.type = rock;
    o.landmark_uid = l.uid;
    o.source = "a.png";
    o.position = l.position;
    o.features.resize(type.features.size());
    contents.observations.push_back(o);
  }
  contents.images = {{.name = "a.png",
                      .footprint = {{{0, 0}, {5, 0}, {5, 5}}},
                      .camera_json = "{}",
                      .taken_utc = {},
                      .sun_azimuth = {},
                      .sun_elevation = {},
                      .gsd = {}}};
  contents.layers = {{.name = "track",
                      .summary = "Track",
                      .kind = geodb::ShapeKind::line,
                      .columns = {},
                      .rows = {{.parts = {{.outer = {{0, 0}, {4, 4}}}}, .values = {}}}}};
  contents.run.started_utc = "2026-11-21T07:21:14Z";
  geodb::write_map(folder / "made.gpkg", contents, {.empty_tables = {"rock"}});
  return read_text(folder / "made.gpkg", "the map");
}

TEST_F(MutatedFiles, OfMaps) {
  check("map.gpkg", map_bytes(folder_), Content::binary, 150, read_map);
}

TEST_F(MutatedFiles, OfMapsThatAreChecked) {
  check("map.gpkg", map_bytes(folder_), Content::binary, 100, [](const std::string& path) {
    if (!geodb::validate_map(path).empty()) throw Error(ErrorCode::input, "the map has errors", path);
  });
}

TEST_F(MutatedFiles, OfImages) {
  check("a.png", dem_bytes(folder_), Content::binary, 100, [](const std::string& path) {
    // A fault of one image is a warning.
    const importers::ListedImages listed =
        importers::list_images({.files = {path}, .import = {.crs = "EPSG:32633"}});
    if (!listed.warnings.empty()) throw Error(ErrorCode::input, listed.warnings[0], path);
  });
}

}  // namespace
}  // namespace waymark::test
