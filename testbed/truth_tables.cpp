// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "testbed/landing/flight.hpp"
#include "testbed/scene_files.hpp"

namespace waymark::testbed {
namespace {

constexpr double kMinListed = 2;  // pixels; minimum size of an outline listed per image

struct Appearances {
  int images = 0;
  double pixels = 0;
};

// Lists the object in every image that shows all of it.
template <class Thing>
Appearances list_appearances(const Thing& thing, const char* type, std::size_t index,
                             const std::vector<Shot>& shots, const std::vector<View>& views,
                             std::string& detections) {
  Appearances seen;
  for (std::size_t i = 0; i < shots.size(); ++i) {
    const auto shape = image_outline(views[i], thing);
    if (!shape) continue;
    ++seen.images;
    seen.pixels = std::max(seen.pixels, shape->diameter());
    if (shape->diameter() >= kMinListed)
      detections += fmt::format("{},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.2f},{}\n", shots[i].name, type,
                                shape->x, shape->y, shape->diameter(), shape->major, shape->minor,
                                shape->angle * 180 / std::numbers::pi, index);
  }
  return seen;
}

}  // namespace

TruthTables truth_tables(const Scenario& scenario, const Scene& scene, const std::vector<Shot>& shots) {
  std::vector<View> views;
  for (const Shot& shot : shots)
    views.push_back(camera_view(true_camera(shot, scenario.exposure.readout_time)));
  TruthTables tables;
  tables.detections = "image,type,x,y,diameter,major,minor,angle,landmark\n";
  tables.landmarks = tables.ignored =
      "type,x,y,z,radius,height,depth,major_axis,minor_axis,orientation,images,pixels,shape,preserved\n";
  std::size_t row = 0;
  for (const TrueCrater& c : scene.craters) {
    const bool kept = c.preserved_fraction() >= kErased;
    std::string unlisted;
    const Appearances seen =
        list_appearances(c, "crater", row, shots, views, kept ? tables.detections : unlisted);
    (kept ? tables.landmarks : tables.ignored) +=
        fmt::format("crater,{:.3f},{:.3f},{:.3f},{:.3f},,{:.3f},{:.3f},{:.3f},{:.4f},{},{:.2f},,{:.2f}\n",
                    c.position.x(), c.position.y(), c.position.z(), c.diameter() / 2, c.depth, c.major,
                    c.minor, c.orientation, seen.images, seen.pixels, c.preserved_fraction());
    if (kept) ++row;
  }
  constexpr const char* kShapes[] = {"ellipsoid", "irregular", "cylinder"};
  for (const TrueRock& r : scene.rocks) {
    const Appearances seen = list_appearances(r, "rock", row, shots, views, tables.detections);
    tables.landmarks += fmt::format("rock,{:.3f},{:.3f},{:.3f},{:.4f},{:.4f},,,,,{},{:.2f},{},\n",
                                    r.position.x(), r.position.y(), r.position.z(), r.width / 2, r.height,
                                    seen.images, seen.pixels, kShapes[static_cast<std::size_t>(r.shape)]);
    ++row;
  }
  return tables;
}

}  // namespace waymark::testbed
