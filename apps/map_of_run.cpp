// SPDX-License-Identifier: Apache-2.0
#include "apps/map_of_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>

#include "apps/crown_layer.hpp"
#include "apps/registries.hpp"
#include "geo/canopy_source.hpp"
#include "geo/dem_handle.hpp"
#include "pipeline/forest/crown_table.hpp"
#include "pipeline/fusion/canopy_view.hpp"

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
std::string told(const std::map<std::string, std::int64_t>& counts) {
  std::string text;
  for (const auto& [type, count] : counts)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, type);
  return text.empty() ? "no landmarks" : text;
}

std::string cell_count(double cells) {
  return cells < 1e6 ? fmt::format("{} cells", cells) : fmt::format("{:.4g} M cells", cells / 1e6);
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

/// Those of tiles, as the engine keeps them: read one tile at a time.
LandmarkParts parts_of(RunResult& result) {
  const auto landmarks = result.take_readers<std::vector<Landmark>>("landmarks");
  const auto evidence = result.take_readers<std::vector<Observation>>("evidence");
  return {.count = landmarks.size(),
          .landmarks = [landmarks](std::size_t part) { return landmarks[part](); },
          .evidence = [evidence](std::size_t part) { return evidence[part](); }};
}

}  // namespace

bool makes_map(const Pipeline& pipeline, const RunResult& result) {
  const auto writes_landmarks = [](const std::unique_ptr<Step>& step) {
    return std::ranges::count(step->spec().outputs, "landmarks", &OutputPort::name) > 0;
  };
  return std::ranges::all_of(pipeline.steps(), [&](const std::unique_ptr<Step>& step) {
    return !writes_landmarks(step) || result.whole(step->spec().name, "landmarks");
  });
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
  contents.parts = parts_of(result);
  contents.landmarks = joined(result.take<std::vector<Landmark>>("landmarks"));
  contents.observations = joined(result.take<std::vector<Observation>>("evidence"));
  auto tables = result.take_readers<CrownTable>("crowns");
  for (CrownTable& table : result.take<CrownTable>("crowns"))
    tables.push_back([held = std::make_shared<const CrownTable>(std::move(table))] { return held; });
  for (const auto& surveys : result.artifacts<Canopies>("canopies")) {
    if (auto survey = survey_layer(*surveys)) contents.layers.push_back(std::move(*survey));
    for (const auto& canopy : *surveys) contents.images.push_back(record_of(canopy_view(*canopy)));
  }
  if (!tables.empty()) contents.layers.push_back(crown_layer(std::move(tables)));
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

std::string summary_of_run(const RunResult& result, const MapContents& contents,
                           const std::map<std::string, std::int64_t>& written, const std::string& map) {
  auto cells = static_cast<double>(result.artifact<DemHandle>("dem")->geometry().cells());
  const auto canopies = result.artifacts<Canopies>("canopies");
  for (const auto& surveys : canopies) cells = static_cast<double>(common_grid(*surveys).cells());
  std::string text = fmt::format("{}: {}\n", map, told(written));
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
