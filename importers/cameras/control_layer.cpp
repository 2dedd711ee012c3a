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
#include "importers/tables/table.hpp"
#include "importers/tables/table_number.hpp"

#include "core/error.hpp"

namespace waymark::importers {
namespace {

/// Cells of a table by the names of its columns.
class NamedCells {
 public:
  explicit NamedCells(const std::string& path) : table_(open_table(path, TableFormat::by_name, "", "")) {}

  const TableHeader& header() const { return table_->header(); }
  bool next() { return table_->next(row_); }
  std::string location() const { return table_->row_location(row_); }

  std::optional<std::size_t> find(std::initializer_list<std::string_view> names) const {
    for (const std::string_view name : names)
      for (std::size_t i = 0; i < header().columns.size(); ++i)
        if (lower_case(header().columns[i]) == name) return i;
    return {};
  }
  std::size_t need(const char* what, std::initializer_list<std::string_view> names, const char* hint) const {
    if (const auto found = find(names)) return *found;
    throw Error(ErrorCode::input, fmt::format("the table has no column '{}'", what), header().path,
                fmt::format("{}; it has: {}", hint, fmt::join(header().columns, ", ")));
  }
  const std::string& text(std::size_t column) const { return row_.cells[column]; }
  double number(std::size_t column) const {
    if (const auto value = to_real(text(column), header().decimal_comma)) return *value;
    throw Error(ErrorCode::input, fmt::format("'{}' is not a number", text(column)),
                fmt::format("{}, column {}", location(), header().columns[column]),
                "every point and mark needs its coordinates");
  }

 private:
  std::unique_ptr<TableSource> table_;
  TableRow row_;
};

double deviation(const NamedCells& cells, std::optional<std::size_t> column, double otherwise) {
  if (!column || is_missing(cells.text(*column))) return otherwise;
  const double sd = cells.number(*column);
  if (sd > 0) return sd;
  throw Error(ErrorCode::input, fmt::format("the standard deviation {} is not above 0", sd), cells.location(),
              "leave the cell empty if it is unknown");
}

bool is_true(std::string_view cell) {
  const std::string text = lower_case(cell);
  return text == "1" || text == "true" || text == "yes" || text == "check" || text == "t" || text == "y";
}

GroundControl read_points(const std::string& path) {
  NamedCells cells(path);
  const char* hint = "points need a name, x, y and z";
  const std::size_t name = cells.need("name", {"name", "point", "id", "label"}, hint);
  const std::size_t x = cells.need("x", {"geom_x", "x", "easting", "lon", "longitude"}, hint);
  const std::size_t y = cells.need("y", {"geom_y", "y", "northing", "lat", "latitude"}, hint);
  const std::size_t z = cells.need("z", {"z", "geom_z", "height", "elevation"}, hint);
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
    const double height =
        is_missing(cells.text(z)) ? std::numeric_limits<double>::quiet_NaN() : cells.number(z);
    point.position = {cells.number(x), cells.number(y), height};
    const GroundControlPoint usual;
    point.sd = {deviation(cells, sd_x, usual.sd.x()), deviation(cells, sd_y, usual.sd.y()),
                deviation(cells, sd_z, usual.sd.z())};
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
                            .pixel = {cells.number(column), cells.number(row)},
                            .sd = deviation(cells, sd, GroundControlMark{}.sd)});
  }
  return all;
}

}  // namespace waymark::importers
