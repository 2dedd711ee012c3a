// SPDX-License-Identifier: Apache-2.0
#include "apps/map_of_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>

#include "apps/registries.hpp"
#include "geo/canopy_source.hpp"
#include "geo/dem_handle.hpp"
#include "pipeline/forest/crown_table.hpp"
#include "pipeline/fusion/image_view.hpp"

namespace waymark {
namespace {

ImageRecord record_of(const ImageView& image) {
  ImageRecord record{.name = image.name,
                     .footprint = image.footprint,
                     .camera_json = camera_json(image),
                     .taken_utc = image.taken_utc,
                     .sun_azimuth = {},
                     .sun_elevation = {},
                     .gsd = {}};
  if (image.sun) record.sun_azimuth = image.sun->azimuth;
  if (image.sun) record.sun_elevation = image.sun->elevation;
  if (std::isfinite(image.gsd)) record.gsd = Meters{image.gsd};
  return record;
}

/// "1204 mountain_top", "12 crater, 3 rock".
std::string count_by_type(const MapContents& contents) {
  std::map<std::string, std::int64_t> counts;
  for (const Landmark& landmark : contents.landmarks) ++counts[contents.types[landmark.type].name];
  std::string text;
  for (const auto& [type, count] : counts)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, type);
  return text.empty() ? "no landmarks" : text;
}

std::string cell_count(double cells) {
  return cells < 1e6 ? fmt::format("{} cells", cells) : fmt::format("{:.4g} M cells", cells / 1e6);
}

ShapeLayer crown_layer() {
  using Kind = AttributeSpec::Kind;
  return {.name = "crown",
          .summary = "Crowns of the trees, seen from above",
          .kind = ShapeKind::polygon,
          .columns = {{"uid", "", Kind::text, "The tree in layer tree; empty where it was not kept"},
                      {"source", "", Kind::text, "Canopy model it was drawn on"},
                      {"height", "m", Kind::real, "Height of the tree"},
                      {"area", "m2", Kind::real, "Area"},
                      {"diameter", "m", Kind::real, "Diameter of the circle of that area"}},
          .style = {.colour = "#1b5e20", .fill = "#66bb6a", .fill_opacity = 0.3, .width = 0.2}};
}

Shape shape_of(CrownShape crown) {
  return {.parts = {{.outer = std::move(crown.ring)}},
          .values = {crown.uid.empty() ? AttributeValue() : AttributeValue(crown.uid), crown.source,
                     crown.height, crown.area, crown.diameter}};
}

/// Unpacked one by one.
MadeShapes shapes_of(std::vector<CrownTable> tables) {
  std::size_t count = 0;
  for (const CrownTable& table : tables) count += table.size();
  const auto held = std::make_shared<const std::vector<CrownTable>>(std::move(tables));
  return {count, [held](std::size_t row) {
            auto table = held->begin();
            for (; row >= table->size(); ++table) row -= table->size();
            return shape_of(table->at(row));
          }};
}

/// Share of the cells of a canopy model that are known, from every 64th of its rows.
double known_share(const CanopySource& canopy) {
  const GridGeometry& grid = canopy.geometry();
  const std::int64_t step = std::max<std::int64_t>(1, grid.rows / 64);
  std::int64_t all = 0, known = 0;
  for (std::int64_t row = 0; row < grid.rows; row += step) {
    const Grid<float> heights = canopy.read({0, row, grid.columns, 1});
    all += grid.columns;
    known += std::ranges::count_if(heights.cells(), [](float h) { return h > kNoCanopy; });
  }
  return all > 0 ? static_cast<double>(known) / static_cast<double>(all) : 0;
}

/// The ground that was searched for trees, where it is a whole rectangle: an inventory of the map needs it.
std::optional<ShapeLayer> survey_layer(const Canopies& canopies) {
  constexpr double kWhole = 0.995;
  ShapeLayer layer{.name = "survey",
                   .summary = "Ground that was searched for trees",
                   .kind = ShapeKind::polygon,
                   .columns = {{"source", "", AttributeSpec::Kind::text, "Canopy model"}},
                   .style = {.colour = "#546e7a", .width = 0.4}};
  if (canopies.size() != 1 || known_share(*canopies[0]) < kWhole) return {};
  const GridGeometry& grid = canopies[0]->geometry();
  const double left = grid.where.x(-0.5), right = grid.where.x(static_cast<double>(grid.columns) - 0.5),
               top = grid.where.y(-0.5), bottom = grid.where.y(static_cast<double>(grid.rows) - 0.5);
  layer.rows.push_back({.parts = {{.outer = {{left, bottom}, {right, bottom}, {right, top}, {left, top}}}},
                        .values = {canopies[0]->name()}});
  return layer;
}

/// What several stages made, one after the other.
template <class T>
std::vector<T> joined(std::vector<std::vector<T>> parts) {
  std::vector<T> all;
  for (auto& part : parts) {
    if (all.empty())
      all = std::move(part);
    else
      std::ranges::move(part, std::back_inserter(all));
  }
  return all;
}

}  // namespace

bool makes_map(const Pipeline& pipeline, const RunResult& result) {
  const auto writes_landmarks = [](const std::unique_ptr<Step>& step) {
    return std::ranges::count(step->spec().outputs, "landmarks", &OutputPort::name) > 0;
  };
  const auto made = result.artifacts<std::vector<Landmark>>("landmarks").size();
  return static_cast<std::ptrdiff_t>(made) == std::ranges::count_if(pipeline.steps(), writes_landmarks);
}

std::vector<std::string> artifacts_of_a_map() {
  return {"dem", "landmarks", "evidence", "crowns", "canopies", "image_views"};
}

MapContents map_of_run(RunResult& result, RunRecord run, bool with_dem) {
  const auto& dem = result.artifact<DemHandle>("dem");
  MapContents contents;
  contents.types = all_types();
  contents.crs = dem->geometry().where.crs;
  contents.run = std::move(run);
  if (with_dem) contents.dem_coverage = dem;
  contents.landmarks = joined(result.take<std::vector<Landmark>>("landmarks"));
  contents.observations = joined(result.take<std::vector<Observation>>("evidence"));
  ShapeLayer crowns = crown_layer();
  auto tables = result.take<CrownTable>("crowns");
  const bool drawn = !tables.empty();
  crowns.more = shapes_of(std::move(tables));
  for (const auto& surveys : result.artifacts<Canopies>("canopies"))
    if (auto survey = survey_layer(*surveys)) contents.layers.push_back(std::move(*survey));
  if (drawn) contents.layers.push_back(std::move(crowns));
  for (const auto& made : result.artifacts<std::vector<ImageView>>("image_views"))
    for (const ImageView& image : *made) contents.images.push_back(record_of(image));
  return contents;
}

std::vector<std::string> types_found(const Pipeline& pipeline) {
  std::vector<std::string> types;
  for (const auto& step : pipeline.steps())
    types.insert(types.end(), step->spec().finds.begin(), step->spec().finds.end());
  std::ranges::sort(types);
  types.erase(std::ranges::unique(types).begin(), types.end());
  return types;
}

std::string summary_of_run(const RunResult& result, const MapContents& contents, const std::string& map) {
  auto cells = static_cast<double>(result.artifact<DemHandle>("dem")->geometry().cells());
  const auto canopies = result.artifacts<Canopies>("canopies");
  for (const auto& surveys : canopies) cells = static_cast<double>(common_grid(*surveys).cells());
  std::string text = fmt::format("{}: {}\n", map, count_by_type(contents));
  if (canopies.empty() && !contents.images.empty()) {
    const auto used = std::ranges::count(contents.observations, "", &Observation::rejected);
    text += fmt::format("{} images, {} observations, {} of them used, {:.2f} s\n", contents.images.size(),
                        contents.observations.size(), used, result.report.seconds);
    return text;
  }
  text += fmt::format("{}, {:.2f} s", cell_count(cells), result.report.seconds);
  std::int64_t reused = 0;
  for (const StageReport& stage : result.report.stages) reused += stage.reused;
  if (reused == 0 && result.report.seconds > 0)
    text += fmt::format(", {:.2g} M cells/s", cells / 1e6 / result.report.seconds);
  return text + "\n";
}

}  // namespace waymark
