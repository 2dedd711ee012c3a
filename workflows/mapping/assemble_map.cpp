// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/assemble_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "geo/canopy_source.hpp"
#include "geo/dem_handle.hpp"
#include "pipeline/buildings/building_outline.hpp"
#include "pipeline/forest/crown_table.hpp"
#include "pipeline/forest/survey_outline.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"
#include "pipeline/fusion/projection/image_view.hpp"
#include "workflows/mapping/crown_layer.hpp"
#include "workflows/mapping/footprint_layer.hpp"
#include "workflows/mapping/summit_layers.hpp"
#include "workflows/mapping/summit_names.hpp"

namespace waymark::workflows {
namespace {

/// Returns the view of a canopy model, treated as an orthophoto of heights whose pixels evidence refers to.
pipeline::ImageView canopy_view(const CanopySource& canopy) {
  const GridGeometry& grid = canopy.geometry();
  const Georeference& where = grid.where;
  const double unit = where.crs.metres_per_unit();
  pipeline::ImageView view;
  view.name = canopy.name();
  view.columns = grid.columns, view.rows = grid.rows;
  view.ortho = pipeline::OrthoGrid{where.x0 * unit, where.y0 * unit, where.dx * unit, where.dy * unit};
  const double west = where.x(-0.5), east = where.x(static_cast<double>(grid.columns) - 0.5);
  const double north = where.y(-0.5), south = where.y(static_cast<double>(grid.rows) - 0.5);
  view.footprint = {{{west, south}, {east, south}, {east, north}, {west, north}, {west, south}}};
  const double cell = std::abs(where.dx * where.dy) * unit * unit;
  view.area = cell * static_cast<double>(grid.cells());
  view.gsd = std::sqrt(cell);
  return view;
}

geodb::ImageRecord image_record(const pipeline::ImageView& image) {
  geodb::ImageRecord record{.name = image.name,
                            .footprint = image.footprint,
                            .camera_json = pipeline::camera_json(image),
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
std::string list_counts(const std::map<std::string, std::int64_t>& counts) {
  std::string text;
  for (const auto& [type, count] : counts)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, type);
  return text.empty() ? "no landmarks" : text;
}

std::string cell_count(double cells) {
  return cells < 1e6 ? fmt::format("{} cells", cells) : fmt::format("{:.4g} M cells", cells / 1e6);
}

/// Returns the ground that was searched. An inventory of the map's trees needs it.
geodb::ShapeLayer survey_layer(const Canopies& canopies, const char* what) {
  geodb::ShapeLayer layer{.name = "survey",
                          .summary = std::string("Ground that was searched for ") + what,
                          .kind = geodb::ShapeKind::polygon,
                          .columns = {{"source", "", AttributeSpec::Kind::text, "Canopy models"}},
                          .style = {.colour = "#546e7a", .width = 0.4}};
  std::string sources;
  for (const auto& canopy : canopies) sources += (sources.empty() ? "" : ", ") + canopy->name();
  geodb::Shape row{.parts = {}, .values = {sources}};
  for (pipeline::SurveyedPart& part : pipeline::survey_outline(canopies))
    row.parts.push_back({.outer = std::move(part.outer), .holes = std::move(part.holes)});
  if (!row.parts.empty()) layer.rows.push_back(std::move(row));
  return layer;
}

/// Concatenates the results of several stages.
template <class T>
std::vector<T> concatenate(std::vector<std::vector<T>> parts) {
  std::vector<T> all;
  for (auto& part : parts) {
    if (all.empty())
      all = std::move(part);
    else
      std::ranges::move(part, std::back_inserter(all));
  }
  return all;
}

using ObservationReaders = std::vector<pipeline::RunResult::Reader<std::vector<Observation>>>;

/// Appends the readers of tiles, then those of parts.
template <class T>
std::vector<pipeline::RunResult::Reader<T>> take_all_readers(pipeline::RunResult& result,
                                                             std::string_view name) {
  auto readers = result.take_readers<T>(name);
  for (auto& part : result.take_parts<T>(name)) readers.push_back(std::move(part));
  return readers;
}

/// Returns readers of tiles and parts, which stay where the engine keeps them. Tiles reject no observations.
geodb::LandmarkParts stored_parts(pipeline::RunResult& result) {
  const auto landmarks = take_all_readers<std::vector<Landmark>>(result, "landmarks");
  const ObservationReaders evidence = take_all_readers<std::vector<Observation>>(result, "evidence");
  const ObservationReaders rejected = take_all_readers<std::vector<Observation>>(result, "rejected");
  const auto nothing = std::make_shared<const std::vector<Observation>>();
  geodb::LandmarkParts parts{.count = landmarks.size()};
  parts.landmarks = [landmarks](std::size_t part) { return landmarks[part](); };
  parts.evidence = [evidence, nothing](std::size_t part) {
    return evidence.empty() ? nothing : evidence[part]();
  };
  if (!rejected.empty())
    parts.rejected = [rejected, nothing, first = landmarks.size() - rejected.size()](std::size_t part) {
      return part < first ? nothing : rejected[part - first]();
    };
  return parts;
}

/// Numbers of observations.
struct ObservationCounts {
  std::size_t all = 0, used = 0;
};

ObservationCounts count_observations(const geodb::MapContents& contents) {
  ObservationCounts count;
  const auto add = [&](const std::vector<Observation>& some) {
    count.all += some.size();
    count.used += static_cast<std::size_t>(std::ranges::count(some, "", &Observation::rejected));
  };
  add(contents.observations);
  for (std::size_t part = 0; part < contents.parts.count; ++part) {
    add(*contents.parts.evidence(part));
    if (contents.parts.rejected) add(*contents.parts.rejected(part));
  }
  return count;
}

}  // namespace

bool has_all_landmarks(const pipeline::Pipeline& pipeline, const pipeline::RunResult& result) {
  const auto writes_landmarks = [](const std::unique_ptr<pipeline::Step>& step) {
    return std::ranges::count(step->spec().outputs, "landmarks", &pipeline::OutputPort::name) > 0;
  };
  return std::ranges::all_of(pipeline.steps(), [&](const std::unique_ptr<pipeline::Step>& step) {
    return !writes_landmarks(step) || result.is_complete(step->spec().name, "landmarks");
  });
}

std::vector<std::string> map_artifacts() {
  return {"dem",        "landmarks", "evidence",    "rejected",   "crowns",
          "footprints", "canopies",  "image_views", "place_names"};
}

geodb::MapContents assemble_map(pipeline::RunResult& result, const TypeRegistry& types, geodb::RunRecord run,
                                bool with_dem) {
  const auto& dem = result.artifact<DemHandle>("dem");
  geodb::MapContents contents;
  contents.types = types;
  contents.crs = dem->geometry().where.crs;
  contents.run = std::move(run);
  if (with_dem) contents.dem_coverage = dem;
  contents.parts = stored_parts(result);
  contents.landmarks = concatenate(result.take<std::vector<Landmark>>("landmarks"));
  contents.observations = concatenate(result.take<std::vector<Observation>>("evidence"));
  for (const auto& names : result.artifacts<importers::PlaceNames>("place_names"))
    name_summits(contents, *names);
  auto tables = take_all_readers<pipeline::CrownTable>(result, "crowns");
  for (pipeline::CrownTable& table : result.take<pipeline::CrownTable>("crowns"))
    tables.push_back(
        [held = std::make_shared<const pipeline::CrownTable>(std::move(table))] { return held; });
  auto outlines = take_all_readers<std::vector<pipeline::BuildingOutline>>(result, "footprints");
  std::vector<pipeline::BuildingOutline> footprints =
      concatenate(result.take<std::vector<pipeline::BuildingOutline>>("footprints"));
  const bool is_town = !outlines.empty() || !footprints.empty();
  for (const auto& read : outlines) std::ranges::copy(*read(), std::back_inserter(footprints));
  const char* const searched = !is_town ? "trees" : tables.empty() ? "buildings" : "buildings and trees";
  for (const auto& surveys : result.artifacts<Canopies>("canopies")) {
    contents.layers.push_back(survey_layer(*surveys, searched));
    for (const auto& canopy : *surveys) contents.images.push_back(image_record(canopy_view(*canopy)));
  }
  if (!tables.empty()) contents.layers.push_back(crown_layer(std::move(tables)));
  if (is_town) contents.layers.push_back(footprint_layer(std::move(footprints)));
  for (geodb::ShapeLayer& layer : summit_layers(contents)) contents.layers.push_back(std::move(layer));
  for (const auto& made : result.artifacts<std::vector<pipeline::ImageView>>("image_views"))
    for (const pipeline::ImageView& image : *made) contents.images.push_back(image_record(image));
  return contents;
}

std::vector<std::string> detected_types(const pipeline::Pipeline& pipeline) {
  std::vector<std::string> types;
  for (const auto& step : pipeline.steps())
    types.insert(types.end(), step->spec().finds.begin(), step->spec().finds.end());
  std::ranges::sort(types);
  types.erase(std::unique(types.begin(), types.end()), types.end());
  return types;
}

std::string summarize_run(const pipeline::RunResult& result, const geodb::MapContents& contents,
                          const std::map<std::string, std::int64_t>& written, const std::string& map) {
  auto cells = static_cast<double>(result.artifact<DemHandle>("dem")->geometry().cells());
  const auto canopies = result.artifacts<Canopies>("canopies");
  for (const auto& surveys : canopies) cells = static_cast<double>(common_grid(*surveys).cells());
  std::string text = fmt::format("{}: {}\n", map, list_counts(written));
  if (canopies.empty() && !contents.images.empty()) {
    const ObservationCounts count = count_observations(contents);
    text += fmt::format("{} images, {} observations, {} of them used, {:.2f} s\n", contents.images.size(),
                        count.all, count.used, result.report.seconds);
    return text;
  }
  text += fmt::format("{}, {:.2f} s", cell_count(cells), result.report.seconds);
  std::int64_t reused = 0;
  for (const pipeline::StageReport& stage : result.report.stages) reused += stage.reused;
  if (reused == 0 && result.report.seconds > 0)
    text += fmt::format(", {:.2g} M cells/s", cells / 1e6 / result.report.seconds);
  return text + "\n";
}

}  // namespace waymark::workflows
