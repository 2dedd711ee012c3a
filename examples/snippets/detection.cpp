// SPDX-License-Identifier: Apache-2.0
// Excerpts of the reference of waymark/detection.hpp.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <numbers>
#include <waymark/detection.hpp>
#include <waymark/testbed.hpp>
using namespace waymark;

namespace {

/// Returns the height of a bowl of 24 cells, 5 deep, in the middle of a plane.
double bowl(std::int64_t column, std::int64_t row) {
  const double r = std::hypot(static_cast<double>(column) - 48, static_cast<double>(row) - 48) / 12;
  return r < 1 ? 5 * (r * r - 1) + 1 : std::exp(-4 * (r - 1));
}

void find_in_pixels() {
  //! [pixels]
  Pixels image(96, 96, 0.5F);  // brightness; light comes from the left
  for (std::int64_t row = 0; row < 96; ++row)
    for (std::int64_t column = 1; column < 95; ++column)
      image(column, row) += static_cast<float>(0.2 * (bowl(column + 1, row) - bowl(column - 1, row)));
  pipeline::CraterSearch craters;
  craters.method = pipeline::CraterMethod::bowl;  // the default
  craters.sun_angle = Radians{std::numbers::pi};  // towards the sun, from x (right) towards y (down)
  for (const Detection& crater : pipeline::find_craters(image, craters))
    std::cout << crater.outline.diameter() << " px across at " << crater.outline.x << ", " << crater.outline.y
              << '\n';
  for (const Detection& rock : pipeline::find_rocks(image, {.sun_angle = craters.sun_angle}))
    std::cout << rock.outline.x << '\n';
  //! [pixels]
  //! [light]
  if (const auto sun = pipeline::estimate_crater_sun_angle(image))  // three clear craters or more
    std::cout << "light from " << sun->angle.value << " rad\n";
  const pipeline::RocksFound rocks =
      pipeline::search_rocks(image, {.method = pipeline::RockMethod::shadow});  // estimates the light as well
  std::cout << rocks.rocks.size() << " rocks, light " << (rocks.light ? "known" : "unknown") << '\n';
  //! [light]
}

void find_in_heights() {
  //! [heights]
  HeightWindow heights(96, 96);
  for (std::int64_t row = 0; row < 96; ++row)
    for (std::int64_t column = 0; column < 96; ++column) heights(column, row) = bowl(column, row);
  for (const pipeline::DemCrater& crater :
       pipeline::find_craters(heights, pipeline::DemCraterSearch{.cell_width = 1, .cell_height = 1}))
    std::cout << crater.diameter() << " m across, " << crater.depth << " m deep\n";
  //! [heights]
}

void find_in_file() {
  std::ofstream("view.json") << R"({"waymark_scenario": 1, "crs": "local", "ground": {"cell": 0.5},
    "rocks": {"k": 0.1, "min_diameter": 0.8, "max_diameter": 5}, "camera": {"columns": 320, "rows": 320},
    "flights": [{"name": "view", "images": 1, "from_altitude": 200, "to_altitude": 200}]})";
  workflows::simulate({.scenario = "view.json", .folder = "view"});
  const std::string image = std::filesystem::directory_iterator("view/images")->path().string();
  //! [detect]
  workflows::DetectRequest request;  // as `waymark detect rocks IMAGE -o rocks.csv --gsd 0.5`
  request.kind = "rocks";
  request.image = image;
  request.output = "rocks.csv";
  request.gsd = 0.5;  // metres per pixel
  const workflows::DetectResult found = workflows::detect(request);
  std::cout << found.detections.detections.size() << " rocks; " << found.light << '\n';
  //! [detect]
}

void train_model() {
  //! [train]
  workflows::TrainRequest request{.what = "craters"};  // as `waymark train craters --scenes 2`
  request.scenes = 2;                                  // far too few for a good model
  request.rounds = 1;
  std::cout << workflows::train(request).model.size() << " bytes\n";
  //! [train]
}

}  // namespace

int main() {
  for (const auto& step : {find_in_pixels, find_in_heights, find_in_file, train_model}) step();
}
