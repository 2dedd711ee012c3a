// SPDX-License-Identifier: Apache-2.0
// A plug-in as its author writes it, with the public headers alone: cones in scans and in images, and a
// stage.
#include <algorithm>
#include <memory>
#include <waymark/mapping.hpp>
#include <waymark/plug_in.hpp>

namespace {

using namespace waymark;

LandmarkType cone_type() {
  return {.name = "traffic_cone",
          .summary = "Cone of a building site",
          .features = {{"diameter", "m", Scale::ratio, 0.1, 2, "At the ground"}},
          .evidence = EvidenceModel::upright,
          .body = {"diameter", 0.5},
          .drawn_as = Solid::cone,
          .colour = "#ff6600"};
}

/// Sights the nearest return, as what is alone on a plain.
localization::SightingSet nearest_return(const localization::LaserScan& scan, std::optional<TypeId> type) {
  localization::SightingSet set{scan.robot_from_sensor, {}};
  const auto nearest = std::ranges::min_element(scan.ranges);
  if (nearest == scan.ranges.end() || !(*nearest > 0 && *nearest < scan.max_range)) return set;
  localization::SeenLandmark seen;
  seen.type = type;
  seen.bearing = scan.first_angle + scan.angle_step * static_cast<double>(nearest - scan.ranges.begin());
  seen.range = *nearest + 0.2;
  set.sightings.push_back(seen);
  return set;
}

struct ConeSettings {
  double brightness = 200;
  void describe(OptionVisitor& option) {
    option("cone_brightness", brightness,
           {.help = "pixels at least as bright are cones", .min = 0, .max = 65535});
  }
};

/// Each bright pixel is a cone of 3 pixels; with the method `dim` each pixel below the limit.
workflows::DetectResult bright_pixels(const workflows::DetectionPlan& plan, double limit) {
  workflows::DetectResult result;
  result.detections = workflows::empty_detections(plan);
  const bool dim = plan.method == "dim";
  const auto find = [&](const Pixels& pixels, double, double) {
    std::vector<Detection> found;
    for (std::int64_t row = 0; row < pixels.rows(); ++row)
      for (std::int64_t column = 0; column < pixels.columns(); ++column)
        if ((pixels(column, row) >= static_cast<float>(limit)) != dim) {
          Detection& one = found.emplace_back();
          one.type = plan.type;
          one.outline = {static_cast<double>(column), static_cast<double>(row), 3, 3, 0};
          one.confidence = 0.75;
        }
    return found;
  };
  result.detections.detections = workflows::search_image(*plan.image, plan.search, find);
  return result;
}

struct CountLandmarks {
  struct Options {
    void describe(OptionVisitor&) {}
  };
  static constexpr pipeline::In<std::vector<Landmark>> landmarks{"landmarks"};
  static constexpr pipeline::Out<std::vector<Landmark>> same{"counted"};
  static pipeline::StageSpec spec() {
    return {
        .name = "count_landmarks", .summary = "Counts landmarks", .inputs = {landmarks}, .outputs = {same}};
  }
  static void run(const Options&, pipeline::StageContext& unit) {
    std::vector<Landmark> all = unit.read(landmarks);
    unit.count_in(std::ssize(all));
    unit.count_out(std::ssize(all));
    unit.write(same, std::move(all));
  }
};

}  // namespace

void waymark_plug_in(workflows::PlugIn& to) {
  to.types.add(cone_type());
  to.stages.add<CountLandmarks>();
  to.scan_detectors.add({.name = "cones",
                         .summary = "Cones, alone on a plain",
                         .record = "laser",
                         .types = {"traffic_cone"},
                         .make = [](const TypeRegistry& types) -> localization::LaserDetector {
                           return [type = localization::type_in_map(types, "traffic_cone")](
                                      const localization::LaserScan& scan) {
                             return nearest_return(scan, type);
                           };
                         }});
  to.image_detectors.add(
      {.name = "cones",
       .summary = "Cones, by their brightness",
       .type = "traffic_cone",
       .methods = {{"bright"}, {"dim"}},
       .search = {.min_diameter = 2, .max_diameter = 20},
       .setting_use = {{.name = "cone_brightness", .value = "VALUE", .methods = {"bright"}}},
       .make = [] {
         const auto own = std::make_shared<ConeSettings>();
         return workflows::ImageDetector{.describe = [own](OptionVisitor& option) { own->describe(option); },
                                         .find =
                                             [own](const workflows::DetectionPlan& plan) {
                                               return bright_pixels(plan, own->brightness);
                                             }};
       }});
}
