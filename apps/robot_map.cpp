// SPDX-License-Identifier: Apache-2.0
#include "apps/robot_map.hpp"

#include "core/error.hpp"

namespace waymark {
namespace {

constexpr std::int64_t kAllAtOnce = 200000;
constexpr double kMargin = 100;  // m

Point<MapCrs> origin_of(const MapStore& store) {
  if (store.crs().kind() == CrsKind::local) return {};
  const std::vector<Landmark> some = store.query({.limit = 1000});
  Point<MapCrs> origin;
  for (const Landmark& l : some) origin.xyz += l.position.xyz / static_cast<double>(some.size());
  if (!some.empty() && store.crs().kind() == CrsKind::geographic) origin = some[0].position;
  origin.xyz.z() = 0;
  return origin;
}

std::vector<MapLandmark> for_robot(const std::vector<Landmark>& landmarks, const TypeRegistry& types,
                                   const LocalFrame& frame, const SensorProfile* sensor) {
  std::vector<MapLandmark> all;
  for (const Landmark& l : landmarks) all.push_back(map_landmark(l, types[l.type], frame, sensor));
  return all;
}

MapQuery::Box box_in_crs(const Eigen::AlignedBox2d& box, const LocalFrame& frame) {
  const auto low = frame.crs_from_map_frame({{box.min().x(), box.min().y(), 0}}).xyz;
  MapQuery::Box all{low.x(), low.y(), low.x(), low.y()};
  for (const double x : {box.min().x(), box.max().x()})
    for (const double y : {box.min().y(), box.max().y()}) {
      const auto corner = frame.crs_from_map_frame({{x, y, 0}}).xyz;
      all = {std::min(all.min_x, corner.x()), std::min(all.min_y, corner.y()),
             std::max(all.max_x, corner.x()), std::max(all.max_y, corner.y())};
    }
  return all;
}

}  // namespace

OpenedMap open_robot_map(const std::string& file, const SensorProfile* sensor, bool may_be_empty) {
  const auto store = std::make_shared<const MapStore>(MapStore::open(file));
  RobotMap map{.store = store,
               .frame = LocalFrame(store->crs(), origin_of(*store)),
               .landmarks = store->count(),
               .bounds = {}};
  if (map.landmarks == 0 && !may_be_empty)
    throw Error(ErrorCode::input, "the map has no landmarks: there is nothing to find the way by", file,
                "use --method odometry, or another map");
  if (map.landmarks <= kAllAtOnce || map.crs().kind() == CrsKind::geographic) {
    LandmarkGrid grid(for_robot(store->query({}), store->types(), map.frame, sensor));
    map.bounds = grid.bounds();
    return {map, LandmarkWindow(std::move(grid))};
  }
  const LocalFrame frame = map.frame;
  LandmarkSource source = [store, frame, sensor](const Eigen::AlignedBox2d& box) {
    return for_robot(store->query({.box = box_in_crs(box, frame)}), store->types(), frame, sensor);
  };
  return {map, LandmarkWindow(std::move(source), kMargin)};
}

}  // namespace waymark
