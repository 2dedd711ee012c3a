// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>

#include "core/lower_case.hpp"
#include "importers/cameras/ground_control.hpp"
#include "importers/tables/named_cells.hpp"
#include "importers/tables/table_number.hpp"

#include "core/error.hpp"

namespace waymark::importers {
namespace {

constexpr const char* kNeeded = "every point and mark needs its coordinates";

bool is_true(std::string_view cell) {
  const std::string text = lower_case(cell);
  return text == "1" || text == "true" || text == "yes" || text == "check" || text == "t" || text == "y";
}

// Height of a point, NaN if unknown. Points of a layer without a third coordinate may have it in a column.
double height_of(const NamedCells& cells) {
  for (const std::string_view name : {"z", "geom_z", "height", "elevation"})
    if (const auto column = cells.find({name}); column && !is_missing(cells.text(*column)))
      return cells.number(*column, kNeeded);
  return std::numeric_limits<double>::quiet_NaN();
}

GroundControl read_points(const std::string& path) {
  NamedCells cells(path);
  const char* hint = "points need a name, x, y and z";
  const std::size_t name = cells.need("name", {"name", "point", "id", "label"}, hint);
  const std::size_t x = cells.need("x", {"geom_x", "x", "easting", "lon", "longitude"}, hint);
  const std::size_t y = cells.need("y", {"geom_y", "y", "northing", "lat", "latitude"}, hint);
  cells.need("z", {"z", "geom_z", "height", "elevation"}, hint);
  const auto check = cells.find({"check"});
  const auto sd_x = cells.find({"x_sd", "position_sd", "sd"}),
             sd_y = cells.find({"y_sd", "position_sd", "sd"}), sd_z = cells.find({"z_sd", "sd"});
  GroundControl all;
  if (const auto& crs = cells.header().crs)
    all.crs = crs->kind() == CrsKind::local ? "local" : crs->wkt2();
  else if (cells.header().columns[x].starts_with("lon"))
    all.crs = "EPSG:4326";
  while (cells.next()) {
    GroundControlPoint point{.name = cells.text(name)};
    if (point.name.empty())
      throw Error(ErrorCode::input, "the control point has no name", cells.location(),
                  "marks refer to points by their names");
    if (std::ranges::count(all.points, point.name, &GroundControlPoint::name) > 0)
      throw Error(ErrorCode::input, fmt::format("two control points have the name '{}'", point.name),
                  cells.location(), "give each point its own name");
    point.position = {cells.number(x, kNeeded), cells.number(y, kNeeded), height_of(cells)};
    const GroundControlPoint usual;
    point.sd = {cells.deviation(sd_x, usual.sd.x()), cells.deviation(sd_y, usual.sd.y()),
                cells.deviation(sd_z, usual.sd.z())};
    point.check = is_check_name(point.name) || (check && is_true(cells.text(*check)));
    all.points.push_back(std::move(point));
  }
  if (all.points.empty())
    throw Error(ErrorCode::input, "there are no control points", path, "add a row for each point");
  return all;
}

}  // namespace

GroundControl read_control_layer(const std::string& points, const std::string& marks) {
  GroundControl all = read_points(points);
  NamedCells cells(marks);
  const char* hint = "marks need point, image, column and row";
  const std::size_t name = cells.need("point", {"point", "name", "id"}, hint),
                    image = cells.need("image", {"image"}, hint);
  const std::size_t column = cells.need("column", {"column", "x", "u"}, hint),
                    row = cells.need("row", {"row", "y", "v"}, hint);
  const auto sd = cells.find({"sd"});
  while (cells.next()) {
    const auto point = std::ranges::find(all.points, cells.text(name), &GroundControlPoint::name);
    if (point == all.points.end())
      throw Error(ErrorCode::input, fmt::format("there is no control point '{}'", cells.text(name)),
                  cells.location(), fmt::format("the names are those of {}", points));
    if (std::ranges::count(point->marks, cells.text(image), &GroundControlMark::image) > 0)
      throw Error(
          ErrorCode::input,
          fmt::format("the point '{}' has two marks in the image '{}'", point->name, cells.text(image)),
          cells.location(), "remove one");
    point->marks.push_back({.image = cells.text(image),
                            .pixel = {cells.number(column, kNeeded), cells.number(row, kNeeded)},
                            .sd = cells.deviation(sd, GroundControlMark{}.sd)});
  }
  return all;
}

}  // namespace waymark::importers
