// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/register_map.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "core/error.hpp"
#include "core/keep_inputs.hpp"
#include "exporters/vector/map_subset.hpp"
#include "geodb/shape_layer.hpp"
#include "geodb/validate_map.hpp"
#include "geodb/write_map.hpp"
#include "importers/rasters/dem.hpp"
#include "importers/rasters/is_raster.hpp"
#include "workflows/mapping/move_map.hpp"
#include "workflows/mapping/moved_dem.hpp"
#include "workflows/mapping/register_by_craters.hpp"
#include "workflows/mapping/register_by_heights.hpp"
#include "workflows/output_path.hpp"
#include "workflows/provenance.hpp"

namespace waymark::workflows {
namespace {

void check_register(const RegisterRequest& request) {
  check_map_output(request.result);
  keep_inputs(request.result, {request.map, request.catalogue, request.dem});
  if (!(request.rules.max_scale > 1 && std::isfinite(request.rules.max_scale)))
    throw Error(ErrorCode::usage,
                fmt::format("--max-scale {:g} is not a factor above 1", request.rules.max_scale));
  if (!(request.rules.max_wrong > 0 && request.rules.max_wrong < 1))
    throw Error(ErrorCode::usage, fmt::format("--max-wrong {:g} is not a probability between 0 and 1",
                                              request.rules.max_wrong));
  if (!(request.rules.max_shift > 0))
    throw Error(ErrorCode::usage,
                fmt::format("--within {:g} is not a distance above 0", request.rules.max_shift));
}

}  // namespace

MapPlace register_map(const RegisterRequest& request, const Callbacks& callbacks) {
  check_register(request);
  const auto started = std::chrono::system_clock::now();
  geodb::check_before_copy(request.map);
  const geodb::MapStore map = geodb::MapStore::open(request.map);
  if (map.crs().kind() == CrsKind::geographic)
    throw Error(ErrorCode::usage, "the map is in degrees, but a registration needs metres", request.map,
                "make it in a projected CRS");
  const MapPlace place = importers::is_raster(request.catalogue) ? register_by_heights(request, map)
                                                                 : register_by_craters(request, map);
  exporters::MapSubset whole = exporters::map_subset(map, {.types = map.types().names()}, map.crs());
  geodb::MapContents& contents = whole.contents;
  for (const std::string& name : geodb::shape_layers(request.map))
    contents.layers.push_back(geodb::read_shape_layer(request.map, name));
  move_map(contents, place.move, place.crs);
  pipeline::StageReport stage;
  stage.stage = "register";
  stage.units = stage.made = 1;
  stage.counts.in = place.compared;
  stage.counts.out = place.agreed;
  if (place.compared > place.agreed) stage.counts.rejected[place.disagreed] = place.compared - place.agreed;
  if (map.has_dem_coverage())
    contents.dem_coverage =
        moved_dem(importers::import_dem({.files = {"GPKG:" + request.map + ":dem"},
                                         .nodata = NodataPolicy::unknown,
                                         .crs = map.crs().kind() == CrsKind::local ? "local" : "",
                                         .inspect = false}),
                  place.move, place.crs);
  contents.run = make_single_step_record(std::move(stage), request.catalogue, request.command_line, started);
  contents.earlier_runs = map.runs();
  geodb::write_map(request.result, contents, {.empty_tables = map.types().names()});
  callbacks.summary(fmt::format("{}: {}", request.result, place.text));
  return place;
}

}  // namespace waymark::workflows
