// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/apps/made_dem.hpp"
#include "tests/apps/made_drive.hpp"
#include "tests/faults/fault_commands.hpp"

namespace waymark::test {
namespace {

/// Writes a map of craters in coordinates of its own, two catalogues of them in UTM, and a map of a body with
/// two lists of craters in an image.
void write_craters(const TempFolder& in) {
  std::string rough = "x,y,radius\n", near = rough, far = rough, moon = rough;
  for (int i = 0; i < 60; ++i) {
    const double x = i * 7919 % 8009, y = i * 4729 % 8011, radius = 100 + i * 37 % 211;
    const auto row = [](double east, double north, double size) {
      return std::to_string(east) + "," + std::to_string(north) + "," + std::to_string(size) + "\n";
    };
    rough += row(x, y, radius), moon += row(x / 100, y / 200, 20 * radius);
    near += row(500'000 + x, 5'200'000 + y, radius), far += row(510'000 + x, 5'200'000 + y, radius);
  }
  write_text(in / "rough.csv", rough), write_text(in / "moon.csv", moon);
  write_text(in / "near.catalogue.csv", near), write_text(in / "far.catalogue.csv", far);
  const std::string three = "x,y,diameter\n10,20,30\n50,60,20\n90,20,25\n";
  write_text(in / "three.pixels.csv", three), write_text(in / "four.pixels.csv", three + "80,90,12\n");
}

}  // namespace

void write_inputs(const TempFolder& in) {
  for (const auto& [name, count] : {std::pair{"few", 300}, std::pair{"many", 1500}}) {
    std::string rocks = "x,y,radius\n", trees = "height,dbh_cm,species\n";
    for (int i = 0; i < count; ++i) {
      rocks += std::to_string(500000 + i % 40 * 7) + "," + std::to_string(5200000 + i / 40 * 7) + "," +
               std::to_string(0.2 + i % 50 * 0.05) + "\n";
      trees += std::to_string(8 + i % 20) + "," + std::to_string(10 + i % 20 * 1.5 + i % 3) + ",spruce\n";
    }
    write_text(in / (std::string(name) + ".csv"), rocks);
    write_text(in / (std::string(name) + ".trees.csv"), trees);
  }
  std::string stems = "uid,x,y,height,diameter,crown_diameter\n";
  for (int i = 0; i < 100; ++i)
    stems += "t" + std::to_string(i) + "," + std::to_string(440005 + 10 * (i % 10)) + "," +
             std::to_string(5400005 + 10 * (i / 10)) + ",20,0.3,4\n";
  write_text(in / "stems.csv", stems);
  write_text(in / "drive_rocks.csv", rocks_csv());
  write_text(in / "short.jsonl", drive_log({.steps = 60}));
  write_text(in / "long.jsonl", drive_log({.steps = 120}));
  MadeDem small = hills(150, 120), large = hills(200, 160);
  make_dem(in / "small.tif", small);
  make_dem(in / "large.tif", large);
  write_text(in / "site.json", R"({"waymark_scenario": 1, "crs": "local", "ground": {"cell": 0.5},
    "camera": {"columns": 64, "rows": 64, "field_of_view": 45},
    "flights": [{"name": "descent", "images": 2, "from_east": -5, "from_north": -5, "from_altitude": 40,
      "to_east": 5, "to_north": 5, "to_altitude": 30, "tilt": 4}]})");
  const auto wall = [](int column, int row) { return column == row ? -9999.0 : column < 20 ? 100.0 : 101.0; };
  const auto cones = [](int column, int row) {
    return std::max(0.0, 15 - 2 * std::hypot(column % 20 - 10, row % 20 - 10));
  };
  for (const auto& [name, side] : {std::pair{"small", 60}, std::pair{"large", 100}}) {
    MadeDem ground{.columns = side, .rows = 50, .height = wall};
    ground.geotransform = {500000, 0.5, 0, 5200000, 0, -0.5};
    make_dem(in / (std::string(name) + ".ground.tif"), ground);
    ground.height = cones;
    make_dem(in / (std::string(name) + ".chm.tif"), ground);
  }
  write_text(in / "flight.json", R"({"waymark_scenario": 1, "seed": 3, "ground": {"cell": 0.5},
    "camera": {"columns": 64, "rows": 64, "field_of_view": 60}, "dem": {"cell": 4},
    "flights": [{"images": 3, "lines": 2, "line_spacing": 25, "from_east": -25, "from_north": 12,
      "from_altitude": 90, "to_east": 25, "to_north": 12, "to_altitude": 90, "track_sd": 0.5}]})");
  write_text(in / "forest.json", R"({"waymark_scenario": 1, "crs": "EPSG:32632", "seed": 5,
    "ground": {"cell": 1, "east": 440000, "north": 5400000, "up": 520},
    "forest": {"width": 40, "height": 30, "stands": 2, "density": 300, "cell": 0.5, "pulses": 2, "points": true}})");
  write_text(in / "street.json", R"({"waymark_scenario": 1, "crs": "local", "street": {"length": 40}})");
  write_craters(in);
  for (const auto& [name, side] : {std::pair{"small", 96}, std::pair{"large", 128}}) {
    std::string pixels;
    for (int i = 0; i < side * side; ++i) {
      const double x = i % side - side / 2.0, y = i / side - side / 2.0, r = std::hypot(x, y);
      pixels += static_cast<char>(static_cast<unsigned char>(110 + (r < 20 ? -x * 4 : 0) + i * 7919 % 5));
    }
    write_text(in / (std::string(name) + ".pgm"),
               "P5 " + std::to_string(side) + " " + std::to_string(side) + " 255\n" + pixels);
  }
}

}  // namespace waymark::test
