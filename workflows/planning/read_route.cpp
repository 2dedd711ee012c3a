// SPDX-License-Identifier: Apache-2.0
#include "workflows/planning/read_route.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/error.hpp"
#include "geo/point_at_height.hpp"
#include "importers/tables/table.hpp"
#include "importers/tables/text_table.hpp"

namespace waymark::workflows {

std::vector<RoutePoint> read_route(const std::string& file, const RobotMap& map) {
  const bool packaged = std::filesystem::path(file).extension() == ".gpkg";
  const auto table =
      importers::open_table(file, importers::TableFormat::by_name, packaged ? "route_station" : "", "");
  const importers::TableHeader& header = table->header();
  const auto column = [&](const char* name) -> int {
    const auto at = std::ranges::find(header.columns, name);
    return at == header.columns.end() ? -1 : static_cast<int>(at - header.columns.begin());
  };
  const char* const hint = "give the .csv, .gpkg or .geojson that `waymark route` wrote";
  const int x = column(header.has_points ? "geom_x" : "x"), y = column(header.has_points ? "geom_y" : "y");
  const int sd = column(header.has_points ? "sd_major" : "sd"), route = column("route"),
            layer = column("layer");
  if (x < 0 || y < 0)
    throw Error(ErrorCode::input, "the route has no columns x and y, and no points", file, hint);
  std::vector<RoutePoint> points;
  importers::TableRow row;
  while (table->next(row)) {
    const auto number = [&](int at) {
      double value = std::nan("");
      if (at >= 0) importers::parse_number(row.cells[static_cast<std::size_t>(at)], value);
      return value;
    };
    if (layer >= 0 && row.cells[static_cast<std::size_t>(layer)] != "route_station") continue;
    if (route >= 0 && number(route) != 1) continue;
    if (!std::isfinite(number(x)) || !std::isfinite(number(y)))
      throw Error(ErrorCode::input, "a station of the route has no position", table->row_location(row), hint);
    RoutePoint point{plan_position(map.frame, number(x), number(y)), number(sd)};
    if (!std::isfinite(point.sd)) point.sd = 0;
    if (!points.empty() && !((point.at - points.back().at).norm() < 50e3))
      throw Error(ErrorCode::input,
                  fmt::format("the route jumps {:.0f} km", (point.at - points.back().at).norm() / 1000),
                  table->row_location(row),
                  "stations are missing or out of order, or the route is not of this map");
    points.push_back(point);
  }
  if (points.size() < 2)
    throw Error(ErrorCode::input, fmt::format("the route has {} stations, two are needed", points.size()),
                file, hint);
  return points;
}

}  // namespace waymark::workflows
