// SPDX-License-Identifier: Apache-2.0
#include "workflows/forest/inventory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/keep_inputs.hpp"
#include "core/options/option_reader.hpp"
#include "core/text_file.hpp"
#include "exporters/report/inventory_report.hpp"
#include "exporters/vector/shape_csv.hpp"
#include "geodb/replace_map.hpp"
#include "geodb/validate_map.hpp"
#include "workflows/forest/stand_areas.hpp"
#include "workflows/forest/stand_figures.hpp"
#include "workflows/output_path.hpp"
#include "workflows/query/area_of_map.hpp"

namespace waymark::workflows {
namespace {

namespace fs = std::filesystem;

void check_request(const InventoryRequest& request) {
  const std::string extension = fs::path(request.output).extension();
  if (extension == ".gpkg")
    check_map_output(request.output);
  else if (extension != ".csv" && !request.output.empty())
    throw Error(ErrorCode::usage, "the output is a .csv or a .gpkg", request.output, "e.g. -o stands.csv");
  const std::string page = fs::path(request.report).extension();
  if (!request.report.empty() && page != ".html" && page != ".htm")
    throw Error(ErrorCode::usage, "the report is an HTML page", request.report,
                "e.g. --report stands.html; a browser prints it as PDF");
  if (!request.stands.empty() && request.grid != 0)
    throw Error(ErrorCode::usage, "--stands and --grid exclude each other", "", "give one of them");
  if (!request.stands_layer.empty() && request.stands.empty())
    throw Error(ErrorCode::usage, "--stands-layer names a layer of --stands, which is not given", "",
                "give both, or leave it out");
  if (request.grid != 0) check_number("--grid", request.grid, "m", {.help = "", .min = 1, .max = 1e5});
  if (request.max_trees < 1)
    throw Error(ErrorCode::usage, fmt::format("--trees-at-once = {} is below 1", request.max_trees));
  check_number("--class-width", request.class_width, "cm", {.help = "", .min = 0.5, .max = 100});
}

StandTables read_tables(const InventoryRequest& request) {
  StandTables tables;
  tables.diameters_file = request.allometry;
  tables.volumes_file = request.volume;
  if (!request.allometry.empty())
    tables.diameters =
        pipeline::parse_allometry(read_text(request.allometry, "this table"), request.allometry);
  if (!request.volume.empty())
    tables.volumes = pipeline::parse_volume(read_text(request.volume, "this table"), request.volume);
  return tables;
}

/// Returns warnings about stands without trees or diameters, the first 20 of them.
std::vector<std::string> stand_warnings(const std::vector<StandResult>& results, bool named_stands) {
  constexpr int kMaxWarnings = 20;
  std::vector<std::string> warnings;
  const auto is_empty = [](const StandResult& r) { return r.figures.trees == 0; };
  if (named_stands && results.size() > 1 && std::ranges::all_of(results, is_empty))
    return {
        "no stand has trees: check the CRS of the stands, and that they are of the site that the map shows"};
  int count = 0;
  for (const StandResult& r : results) {
    if (named_stands && r.figures.trees == 0 && ++count <= kMaxWarnings)
      warnings.push_back(fmt::format("stand {} has no trees", r.stand.name));
    if (r.figures.without_diameter > 0 && ++count <= kMaxWarnings)
      warnings.push_back(
          fmt::format("stand {}: {} of {} trees have no diameter, so basal area and volume lack them",
                      r.stand.name, r.figures.without_diameter, r.figures.trees));
  }
  if (count > kMaxWarnings)
    warnings.push_back(fmt::format("{} more warnings of this kind", count - kMaxWarnings));
  return warnings;
}

/// Returns the layer with every n-th of its rows, for a picture.
geodb::ShapeLayer thinned(geodb::ShapeLayer layer, std::size_t every) {
  std::size_t row = 0;
  layer.generator([&](const geodb::Shape& shape) {
    if (row++ % every == 0) layer.rows.push_back(shape);
  });
  layer.generator = {};
  return layer;
}

/// Writes stands as CSV, or stands and trees as layers of a copy of the map or of the map itself.
void write_output(const InventoryRequest& request, const geodb::ShapeLayer& stands,
                  const geodb::ShapeLayer& trees) {
  if (fs::path(request.output).extension() == ".csv")
    return write_file(request.output, exporters::layer_to_csv(stands));
  geodb::check_before_copy(request.map);
  const std::vector layers{stands, trees};
  std::error_code other;
  if (fs::equivalent(request.map, request.output, other)) return geodb::write_layers(request.output, layers);
  AtomicFile copy(request.output);
  fs::copy_file(request.map, copy.path(), fs::copy_options::overwrite_existing);
  geodb::write_layers(copy.path(), layers, geodb::MapAccess::exclusive);
  geodb::replace_map(copy);
}

void write_report_page(const InventoryRequest& request, const InventoryResult& result,
                       const geodb::ShapeLayer& stands, const geodb::ShapeLayer& trees, const Crs& crs) {
  const std::size_t every = 1 + result.trees / exporters::InventoryPage::kMaxTrees;
  exporters::write_inventory_report(request.report, {.title = fs::path(request.map).filename().string(),
                                                     .crs = crs.id(),
                                                     .stands = stands,
                                                     .trees = thinned(trees, every),
                                                     .tree_count = result.trees,
                                                     .warnings = result.warnings,
                                                     .failed = result.failed});
}

}  // namespace

InventoryResult inventory(const InventoryRequest& given, const Callbacks& callbacks) {
  InventoryRequest request = given;
  if (!request.aoi.empty()) {
    if (!request.stands.empty() || request.grid != 0)
      throw Error(ErrorCode::usage, "--aoi exchanges the stands, and --stands or --grid is given, too",
                  "--aoi", "cut the stands to the area first: ogr2ogr -clipsrc AREA PART.gpkg STANDS");
    area_of_map(request.aoi, request.map);  // its errors
    request.stands = std::exchange(request.aoi, {});
  }
  check_request(request);
  for (const std::string& output : {request.output, request.report})
    keep_inputs(output, {request.stands, request.allometry, request.volume, request.recall});
  keep_inputs(request.report, {request.map});
  InventoryResult result;
  const auto warn = [&](const std::string& warning) {
    callbacks.warning(warning);
    result.warnings.push_back(warning);
  };
  const geodb::MapStore map = geodb::MapStore::open(request.map);
  const TreeReader reader(map);
  if (reader.count() == 0) warn("the map has no trees: every figure is 0 or empty");
  StandAreas areas = read_stand_areas({request.stands, request.stands_layer, request.grid}, map, reader);
  for (const std::string& warning : areas.warnings) warn(warning);
  result.failed = std::move(areas.failed);
  const StandBatches stands(reader, std::move(areas.stands), request.max_trees);
  const StandTables tables = read_tables(request);
  pipeline::InventoryOptions options{.class_width = request.class_width / 100};
  if (!request.recall.empty())
    options.recall = pipeline::parse_recall(read_text(request.recall, "this table"), request.recall);
  stands.visit([&](const MapTrees& trees, const NamedStand& stand) {
    result.stands.push_back(compute_stand_figures(trees, stand, tables, options));
  });
  for (const std::string& warning : stand_warnings(result.stands, !request.stands.empty())) warn(warning);
  for (const StandResult& stand : result.stands)
    result.trees += static_cast<std::size_t>(stand.figures.trees);
  const geodb::ShapeLayer stand_rows = stand_layer(result.stands), tree_rows = tree_layer(stands, tables);
  if (!request.output.empty()) write_output(request, stand_rows, tree_rows);
  if (!request.report.empty()) write_report_page(request, result, stand_rows, tree_rows, map.crs());
  return result;
}

}  // namespace waymark::workflows
