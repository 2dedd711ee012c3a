// SPDX-License-Identifier: Apache-2.0
#include "importers/cameras/world_to_grid.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <memory>

#include "core/error.hpp"
#include "core/solve.hpp"
#include "geo/local_frame.hpp"
#include "importers/images/image.hpp"

namespace waymark::importers {
namespace {

using Vector = Eigen::Vector3d;

[[noreturn]] void refuse(const std::string& problem, const std::string& path, const std::string& hint) {
  throw Error(ErrorCode::input, problem, path, hint);
}

// Transforms longitude, latitude, height on the map's body to the grid.
WorldToGrid from_geographic(const Crs& map, double offset) {
  const auto transform = std::make_shared<const CrsTransform>(geographic_crs(map), map);
  const double unit = map.metres_per_unit();
  return [transform, unit, offset](const Vector& p) -> Vector {
    const auto [x, y] = (*transform)(p.x(), p.y());
    return {x * unit, y * unit, p.z() + offset};
  };
}

WorldToGrid from_enu(const CameraWorld& world, const Crs& map, double offset, const std::string& path) {
  if (map.kind() == CrsKind::local)
    return [offset](const Vector& p) -> Vector { return p + Vector(0, 0, offset); };
  if (map.body().name != earth().name && world.crs == "EPSG:4326")
    refuse(fmt::format("the cameras are on the Earth, the map on {}", map.body().name), path,
           "check the option crs");
  // ENU about a position in the map's own datum: WGS 84 and similar datums differ by less than a metre.
  const auto frame = std::make_shared<const LocalFrame>(geographic_crs(map), Point<MapCrs>{world.origin});
  return [frame, to_grid = from_geographic(map, offset)](const Vector& p) {
    return to_grid(frame->crs_from_map_frame({p}).xyz);
  };
}

// East, north, up at longitude 0, latitude 0, height 0 are y, z, x - radius of the body.
WorldToGrid from_earth(const Crs& map, double offset, const std::string& path) {
  if (map.kind() == CrsKind::local)
    refuse("the camera positions are body-fixed, but the map is on no body", path,
           "name the map's CRS in the option crs");
  const auto frame = std::make_shared<const LocalFrame>(geographic_crs(map), Point<MapCrs>{});
  const double radius = map.body().equatorial_radius;
  return [frame, radius, to_grid = from_geographic(map, offset)](const Vector& p) {
    return to_grid(frame->crs_from_map_frame({Vector(p.y(), p.z(), p.x() - radius)}).xyz);
  };
}

WorldToGrid from_grid(const std::string& definition, const Crs& map, double offset, const std::string& path) {
  const Crs from = definition.empty() ? map : Crs::from_text(definition);
  if (from.kind() == CrsKind::geographic) {
    if (map.kind() == CrsKind::local)
      refuse("the cameras are in degrees, but the map is on no body", path,
             "name the map's CRS in the option crs");
    return from_geographic(map, offset);
  }
  if (from.same_as(map)) return [offset](const Vector& p) -> Vector { return p + Vector(0, 0, offset); };
  const auto transform = std::make_shared<const CrsTransform>(from, map);
  const double in = from.metres_per_unit(), out = map.metres_per_unit();
  return [transform, in, out, offset](const Vector& p) -> Vector {
    const auto [x, y] = (*transform)(p.x() / in, p.y() / in);
    return {x * out, y * out, p.z() + offset};
  };
}

}  // namespace

std::string utm_zone(double lon, double lat) {
  const int zone = static_cast<int>(std::clamp(std::floor((lon + 180) / 6) + 1, 1.0, 60.0));
  return fmt::format("EPSG:{}", (lat < 0 ? 32700 : 32600) + zone);
}

WorldToGrid world_to_grid(const CameraWorld& world, const std::string& camera_crs, const Crs& map,
                          double height_offset, const std::string& path) {
  switch (world.axes) {
    case CameraWorld::Axes::grid:
      return from_grid(world.crs.empty() ? camera_crs : world.crs, map, height_offset, path);
    case CameraWorld::Axes::enu:
      return from_enu(world, map, height_offset, path);
    case CameraWorld::Axes::earth:
      return from_earth(map, height_offset, path);
    case CameraWorld::Axes::arbitrary:
      break;
  }
  refuse("the camera frame has no position, direction or scale in the map", path,
         "name a file of control points (option control_points) or a similarity; "
         "docs/how_to/tie_cameras_to_the_map.md shows both");
}

LocalRotation local_rotation_at(const WorldToGrid& to_grid, const Eigen::Vector3d& place) {
  constexpr double kStep = 10;
  Eigen::Matrix3d axes;
  for (int i = 0; i < 3; ++i) {
    const Vector step = kStep * Vector::Unit(i);
    axes.col(i) = (to_grid(place + step) - to_grid(place - step)) / (2 * kStep);
  }
  const SingularValues3 parts = singular_values(axes);
  LocalRotation turn;
  turn.rotation = parts.u * parts.v.transpose();
  if (turn.rotation.determinant() < 0) turn.rotation = -turn.rotation;
  turn.stretch = parts.values[0] / parts.values[2];
  return turn;
}

}  // namespace waymark::importers
