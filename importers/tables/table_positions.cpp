// SPDX-License-Identifier: Apache-2.0
#include "importers/tables/table_positions.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"
#include "core/rotate_axes.hpp"
#include "geo/axes_rotation.hpp"
#include "importers/tables/table_landmarks.hpp"

namespace waymark::importers {
namespace {

Crs crs_of_table(const TableHeader& table, const std::string& given, const std::optional<Crs>& map,
                 bool named_degrees) {
  if (!given.empty()) return Crs::from_text(given);
  if (table.crs) return *table.crs;
  if (!map)
    throw Error(ErrorCode::usage, "the table does not name its CRS", table.path,
                "pass --map-crs, e.g. --map-crs EPSG:4326 for degrees on Earth, IAU_2015:30100 on the Moon, "
                "IAU_2015:49900 on Mars, or local for metres on no body");
  return named_degrees && map->kind() == CrsKind::projected ? geographic_crs(*map) : *map;
}

}  // namespace

TablePositions::TablePositions(const TableHeader& table, const std::string& table_crs,
                               const std::string& map_crs, bool named_degrees) {
  std::optional<Crs> map;
  if (!map_crs.empty()) map = Crs::from_text(map_crs);
  table_ = crs_of_table(table, table_crs, map, named_degrees);
  map_ = map.value_or(table_);
  guessed_ = table_crs.empty() && !table.crs;
  if (guessed_ && !table_.same_as(map_))
    notes_.push_back(
        fmt::format("longitudes and latitudes are assumed to be in {}; override with --crs", table_.id()));
  if (table_.kind() == CrsKind::projected) to_degrees_.emplace(table_, geographic_crs(table_));
  if (table_.same_as(map_)) return;
  try {
    transform_.emplace(table_, map_);
  } catch (const Error& error) {
    throw Error(ErrorCode::usage,
                fmt::format("the table is in {}, which cannot be transformed to {}: {}", table_.id(),
                            map_.id(), error.problem()),
                table.path,
                "pass the CRS of its coordinates with --crs (GeoJSON and KML always declare WGS 84)");
  }
}

std::string TablePositions::transform_to_map(Point<MapCrs>& position) {
  const double x = position.xyz.x(), y = position.xyz.y();
  if (!std::isfinite(x) || !std::isfinite(y)) return "no position";
  if (table_.kind() == CrsKind::geographic && std::abs(y) > 90) return "latitude beyond 90 degrees";
  if (table_.kind() == CrsKind::geographic && std::abs(x) > 720) return "longitude beyond two turns";
  ++positions_;
  like_degrees_ += std::abs(x) <= 360 && std::abs(y) <= 90;
  if (transform_) {
    const auto there = (*transform_)(x, y);
    if (!std::isfinite(there.x) || !std::isfinite(there.y)) return "no position in " + map_.id();
    position.xyz.head<2>() = Eigen::Vector2d(there.x, there.y);
  }
  if (area_ && !area_->contains(position.xyz.x(), position.xyz.y())) return kOutsideArea;
  return {};
}

void TablePositions::keep_inside(const std::string& aoi) {
  if (!aoi.empty()) area_ = read_area_of_interest(aoi, map_);
}

std::string TablePositions::transform_to_map(Landmark& landmark, std::span<const FeatureSpec> specs,
                                             AngleReference angles) {
  const Point<MapCrs> of_table = landmark.position;
  std::string reason = transform_to_map(landmark.position);
  if (reason.empty()) rotate_axes(landmark, specs, [&] { return rotation_to_map(of_table, angles); });
  return reason;
}

double TablePositions::rotation_to_map(const Point<MapCrs>& of_table, AngleReference angles) const {
  const double x = of_table.xyz.x(), y = of_table.xyz.y();
  double rotation = 0;
  if (angles == AngleReference::true_north && to_degrees_)
    rotation -= axes_rotation(*to_degrees_, table_, geographic_crs(table_), x, y);
  if (transform_) rotation += axes_rotation(*transform_, table_, map_, x, y);
  return rotation;
}

std::vector<std::string> TablePositions::warnings() const {
  std::vector<std::string> all = notes_;
  if (guessed_ && table_.kind() == CrsKind::projected && positions_ > 2 && like_degrees_ == positions_)
    all.push_back(
        fmt::format("{} is in metres, but these positions look like degrees: if they are, pass --crs {}",
                    table_.id(), geographic_crs(table_).id()));
  return all;
}

}  // namespace waymark::importers
