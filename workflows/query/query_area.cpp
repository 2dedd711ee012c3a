// SPDX-License-Identifier: Apache-2.0
#include "workflows/query/query_area.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "exporters/vector/reproject.hpp"

namespace waymark::workflows {
namespace {

double east_of(const geodb::MapQuery::Box& box, const Crs& crs) {
  const bool over_antimeridian = crs.kind() == CrsKind::geographic && box.min_x > box.max_x;
  return over_antimeridian ? box.max_x + 360 : box.max_x;
}

}  // namespace

geodb::MapQuery::Box covering_box(const geodb::MapQuery::Box& box, const Crs& from, const Crs& map) {
  constexpr int kSteps = 32;
  constexpr double kMargin = 0.01;
  const CrsTransform transform(from, map);
  const double width = east_of(box, from) - box.min_x, height = box.max_y - box.min_y;
  geodb::MapQuery::Box cover{INFINITY, INFINITY, -INFINITY, -INFINITY};
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; j <= kSteps; ++j) {
      const auto at = transform(box.min_x + width * i / kSteps, box.min_y + height * j / kSteps);
      if (!std::isfinite(at.x) || !std::isfinite(at.y)) continue;
      cover = {std::min(cover.min_x, at.x), std::min(cover.min_y, at.y), std::max(cover.max_x, at.x),
               std::max(cover.max_y, at.y)};
    }
  if (!(cover.min_x <= cover.max_x))
    throw Error(ErrorCode::usage, "the box of --bbox has no place in the map's CRS, " + map.id(),
                "--crs " + from.id());
  const double x = kMargin * (cover.max_x - cover.min_x), y = kMargin * (cover.max_y - cover.min_y);
  return {cover.min_x - x, cover.min_y - y, cover.max_x + x, cover.max_y + y};
}

bool inside(const geodb::MapQuery::Box& box, const Point<MapCrs>& point, const Crs& crs) {
  const double east = east_of(box, crs);
  double x = point.xyz.x();
  if (crs.kind() == CrsKind::geographic) x = box.min_x + std::fmod(std::fmod(x - box.min_x, 360) + 360, 360);
  return x >= box.min_x && x <= east && point.xyz.y() >= box.min_y && point.xyz.y() <= box.max_y;
}

std::vector<Landmark> transform_landmarks(const std::vector<Landmark>& landmarks, const TypeRegistry& types,
                                          const Crs& from, const Crs& to) {
  if (from.same_as(to)) return landmarks;
  std::vector<std::vector<Landmark>> of_type(types.size());
  for (const Landmark& landmark : landmarks) of_type[landmark.type].push_back(landmark);
  for (TypeId type = 0; type < types.size(); ++type)
    of_type[type] = exporters::reproject(std::move(of_type[type]), types[type], from, to).landmarks;
  std::vector<Landmark> result;
  std::vector<std::size_t> next(types.size(), 0);
  for (const Landmark& landmark : landmarks) {
    auto& moved = of_type[landmark.type];
    std::size_t& at = next[landmark.type];
    if (at < moved.size() && moved[at].uid == landmark.uid) result.push_back(std::move(moved[at++]));
  }
  return result;
}

}  // namespace waymark::workflows
