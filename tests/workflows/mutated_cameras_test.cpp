// SPDX-License-Identifier: Apache-2.0
// Every reader of cameras, given hundreds of damaged files.
#include "importers/cameras/camera_set.hpp"
#include "tests/support/mutated_files.hpp"

namespace waymark::test {
namespace {

namespace fs = std::filesystem;

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

}  // namespace
}  // namespace waymark::test
