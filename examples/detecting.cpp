// SPDX-License-Identifier: Apache-2.0
// Craters and rocks in one image, as `waymark detect craters IMAGE -o craters.csv` finds them.
#include <fstream>
#include <iostream>
#include <waymark/detection.hpp>
#include <waymark/testbed.hpp>
using namespace waymark;

namespace {

// A landing site that the testbed makes: one image of 640 x 640 pixels from 250 m.
constexpr const char* kScenario = R"({
  "waymark_scenario": 1, "name": "One image", "crs": "local", "seed": 7,
  "ground": {"cell": 0.4},
  "craters": {"density": 0.5, "min_diameter": 4, "max_diameter": 80},
  "rocks": {"k": 0.1, "min_diameter": 0.8, "max_diameter": 5},
  "sun": {"azimuth": 295, "elevation": 38},
  "camera": {"columns": 640, "rows": 640, "field_of_view": 45},
  "flights": [{"name": "view", "images": 1, "from_altitude": 250, "to_altitude": 250}]})";

std::string only_image(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) return entry.path().string();
  return {};
}

}  // namespace

int main() try {
  std::ofstream("one_image.json") << kScenario;
  workflows::simulate({.scenario = "one_image.json", .folder = "one_image"});

  std::size_t found = 0;
  for (const std::string kind : {"craters", "rocks"}) {
    workflows::DetectRequest request;
    request.kind = kind;
    request.image = only_image("one_image/images");
    request.output = kind + ".csv";
    const workflows::DetectResult result = workflows::detect(request);
    for (const std::string& warning : result.warnings) std::cout << "warning: " << warning << '\n';
    std::cout << result.detections.detections.size() << ' ' << kind << "; " << result.light << '\n';
    found += result.detections.detections.size();
  }
  return found > 0 ? 0 : 1;
} catch (const Error& error) {
  std::cerr << error.what() << '\n';
  return exit_code(error.code());
}
