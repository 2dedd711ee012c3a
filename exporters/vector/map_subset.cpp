// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/map_subset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "exporters/vector/reproject.hpp"

namespace waymark::exporters {
namespace {

void reproject(std::vector<geodb::ImageRecord>& images, const Crs& from, const Crs& to) {
  if (from.same_as(to)) return;
  const CrsTransform transform(from, to);
  for (geodb::ImageRecord& image : images)
    for (auto& ring : image.footprint)
      for (Eigen::Vector2d& corner : ring) {
        const auto there = transform(corner.x(), corner.y());
        corner = {there.x, there.y};
      }
}

void reproject(std::vector<Observation>& observations, const Crs& from, const Crs& to) {
  if (from.same_as(to)) return;
  const CrsTransform transform(from, to);
  for (Observation& seen : observations) {
    const auto there = transform(seen.position.xyz.x(), seen.position.xyz.y());
    seen.position.xyz.head<2>() = Eigen::Vector2d(there.x, there.y);
  }
}

bool keep(Observation& seen, const TypeRegistry& from, const TypeRegistry& to,
          const std::set<std::string>& uids) {
  const std::string& type = from[seen.type].name;
  if (to.find(type) == nullptr || !(seen.landmark_uid.empty() || uids.contains(seen.landmark_uid)))
    return false;
  seen.type = to.id(type);
  return seen.position.xyz.head<2>().allFinite();
}

}  // namespace

MapSubset map_subset(const geodb::MapStore& map, const std::vector<std::string>& types, const Crs& crs) {
  MapSubset subset;
  geodb::MapContents& contents = subset.contents;
  contents.crs = crs;
  std::set<std::string> uids;
  for (const std::string& name : types) {
    const LandmarkType& type = *map.types().find(name);
    const TypeId id = contents.types.add(type);
    Reprojected found = reproject(map.query({.types = {name}}), type, map.crs(), crs);
    subset.layers.push_back({name, static_cast<std::int64_t>(found.landmarks.size())});
    if (found.lost > 0)
      subset.warnings.push_back(
          fmt::format("{} {} landmarks have no position in {} and are left out", found.lost, name, crs.id()));
    for (Landmark& landmark : found.landmarks) {
      landmark.type = id;
      uids.insert(landmark.uid);
      contents.landmarks.push_back(std::move(landmark));
    }
  }
  contents.observations = map.observations();
  reproject(contents.observations, map.crs(), crs);
  std::erase_if(contents.observations,
                [&](Observation& seen) { return !keep(seen, map.types(), contents.types, uids); });
  contents.images = map.images();
  reproject(contents.images, map.crs(), crs);
  const auto runs = map.runs();
  if (!runs.empty()) contents.run = runs.back();
  if (runs.size() > 1)
    subset.warnings.push_back(fmt::format("only the latest of {} runs is kept", runs.size()));
  if (map.has_dem_coverage()) subset.warnings.push_back("the elevation tiles of the map are left out");
  return subset;
}

}  // namespace waymark::exporters
