// SPDX-License-Identifier: Apache-2.0
// Excerpts of the reference of waymark/plug_in.hpp.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <waymark/plug_in.hpp>
using namespace waymark;

namespace {

//! [scan]
/// Sights the nearest return of a scan.
localization::LaserDetector make_buoys(const TypeRegistry& types) {
  const std::optional<TypeId> type = localization::type_in_map(types, "buoy");
  return [type](const localization::LaserScan& scan) {
    localization::SightingSet set{scan.robot_from_sensor, {}};
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < scan.ranges.size(); ++i)
      if (scan.ranges[i] < scan.ranges[nearest]) nearest = i;
    if (scan.ranges.empty() || !(scan.ranges[nearest] < scan.max_range)) return set;
    localization::SeenLandmark seen;
    seen.type = type;
    seen.bearing = scan.first_angle + scan.angle_step * static_cast<double>(nearest);
    seen.range = scan.ranges[nearest] + 0.5;  // radius of a buoy
    set.sightings.push_back(seen);
    return set;
  };
}
//! [scan]

/// Sights the middle of all points as a buoy.
localization::PointDetector make_buoys_3d(const TypeRegistry& types) {
  return [type = localization::type_in_map(types, "buoy")](const localization::PointCloud& cloud) {
    localization::SightingSet set{cloud.robot_from_sensor, {}};
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (const Eigen::Vector3f& point : cloud.points) sum += point;
    const double count = static_cast<double>(cloud.points.size()), range = sum.head<2>().norm() / count;
    if (cloud.points.empty() || !(range > 0)) return set;
    localization::SeenLandmark seen;
    seen.type = type;
    seen.bearing = std::atan2(sum.y(), sum.x());
    seen.range = range;
    set.sightings.push_back(seen);
    return set;
  };
}

//! [image]
struct BuoySettings {
  double brightness = 200;
  void describe(OptionVisitor& option) {
    option("buoy_brightness", brightness, {.help = "pixels at least as bright are buoys", .min = 0});
  }
};

/// Every bright pixel is a buoy. search_image() reads large images by pieces.
workflows::DetectResult find_buoys(const workflows::DetectionPlan& plan, const BuoySettings& settings) {
  workflows::DetectResult result;
  result.detections = workflows::empty_detections(plan);
  const double least = plan.min_confidence.value_or(workflows::kUsualConfidence);
  result.detections.detections =
      workflows::search_image(*plan.image, plan.search, [&](const Pixels& pixels, double, double) {
        std::vector<Detection> found;
        for (std::int64_t row = 0; row < pixels.rows(); ++row)
          for (std::int64_t column = 0; column < pixels.columns(); ++column)
            if (pixels(column, row) >= static_cast<float>(settings.brightness) && least <= 0.9) {
              Detection& one = found.emplace_back();
              one.type = plan.type;
              one.outline = {static_cast<double>(column), static_cast<double>(row), 3, 3, 0};
              one.confidence = 0.9;
            }
        return found;
      });
  return result;
}

workflows::ImageDetector make_buoys_in_images() {
  const auto own = std::make_shared<BuoySettings>();
  return {.describe = [own](OptionVisitor& option) { own->describe(option); },
          .find = [own](const workflows::DetectionPlan& plan) { return find_buoys(plan, *own); }};
}
//! [image]

}  // namespace

//! [register]
void waymark_plug_in(workflows::PlugIn& to) {
  to.types.add({.name = "buoy",
                .summary = "Buoy at anchor",
                .features = {{"diameter", "m", Scale::ratio, 0.2, 5, "At the waterline"}},
                .evidence = EvidenceModel::upright});
  to.scan_detectors.add({.name = "buoys",
                         .summary = "The nearest thing on open water",
                         .record = "laser",
                         .types = {"buoy"},
                         .make = make_buoys});
  to.scan_detectors.add({.name = "buoys_3d",
                         .summary = "The same in 3-D scans",
                         .record = "points",
                         .types = {"buoy"},
                         .make_points = make_buoys_3d});
  to.image_detectors.add(
      {.name = "buoys",
       .summary = "Buoys, by their brightness",
       .type = "buoy",
       .methods = {{.name = "bright"}},
       .search = {.min_diameter = 2, .max_diameter = 20},
       .setting_use = {{.name = "buoy_brightness", .value = "VALUE", .methods = {"bright"}}},
       .make = make_buoys_in_images});
}
//! [register]

int main(int argc, char** argv) {
  // As the program does with its own registries.
  workflows::PlugIn made;
  register_landmark_types(made.types);
  localization::register_laser_detectors(made.scan_detectors);
  localization::register_point_detectors(made.scan_detectors);
  waymark_plug_in(made);
  std::cout << waymark_plug_in_build() << '\n' << workflows::plug_in_build() << '\n';
  localization::LaserScan scan;
  scan.angle_step = 0.1;
  scan.ranges = {80, 12, 80};
  const localization::DetectorSpec* const buoys = made.scan_detectors.find("buoys");
  const bool sighted = buoys && buoys->make(made.types)(scan).sightings.size() == 1;
  //! [load]
  if (argc > 1 && std::filesystem::path(argv[1]).extension() == ".so") workflows::load_plug_in(argv[1]);
  for (const workflows::ImageDetectorSpec& one : workflows::image_detectors()) {
    std::cout << one.name << ": " << one.type << '\n';
    for (const OptionRow& row : workflows::settings_of(one)) {
      const workflows::SettingUse use = workflows::use_of_setting(one, row.name);
      std::cout << "  " << row.name << ' ' << use.value << '\n';
    }
  }
  //! [load]
  const workflows::ImageDetectorTable& known = made.image_detectors;
  return sighted && known.find("buoys") ? 0 : 1;
}
