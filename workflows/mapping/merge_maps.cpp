// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/merge_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>
#include <utility>

#include "core/error.hpp"
#include "core/keep_inputs.hpp"
#include "core/locked_folder.hpp"
#include "core/options/option_reader.hpp"
#include "core/output_error.hpp"
#include "geodb/write_map.hpp"
#include "importers/hash.hpp"
#include "workflows/mapping/join_maps.hpp"
#include "workflows/mapping/joined_layers.hpp"
#include "workflows/mapping/map_changes.hpp"
#include "workflows/mapping/merged_types.hpp"
#include "workflows/output_path.hpp"
#include "workflows/provenance.hpp"
#include "workflows/query/area_of_map.hpp"
#include "workflows/query/map_of_area.hpp"

namespace waymark::workflows {
namespace {

namespace fs = std::filesystem;

void check_request(const MergeRequest& request) {
  check_map_output(request.result);
  if (request.maps.size() < 2)
    throw Error(ErrorCode::usage, "a merge needs two maps or more", "",
                "waymark merge A.gpkg B.gpkg -o C.gpkg");
  if (request.changes && request.maps.size() != 2)
    throw Error(
        ErrorCode::usage,
        fmt::format("changes are those from one map to a second, not of {} maps", request.maps.size()),
        "--changes", "waymark merge EARLIER.gpkg LATER.gpkg --changes -o MAP.gpkg");
  check_number("--max-move", request.max_move, "m", {.help = "", .min = 0, .max = 1e6});
  keep_inputs(request.result, request.maps);
  keep_inputs(request.result, {request.aoi});
}

/// Returns the maps in the order of their names and contents, so that the order of the request does not
/// matter.
std::vector<InputFile> sorted_inputs(const std::vector<std::string>& maps) {
  std::vector<InputFile> inputs;
  for (const std::string& map : maps) inputs.push_back(importers::hash_file(map));
  std::ranges::sort(inputs, {}, [](const InputFile& file) {
    return std::tuple(std::filesystem::path(file.path).filename().string(), file.sha256, file.path);
  });
  return inputs;
}

void check_crs(const LoadedMap& a, const std::string& name_a, const LoadedMap& b, const std::string& name_b) {
  if (a.crs.same_as(b.crs)) return;
  const bool local = a.crs.kind() == CrsKind::local || b.crs.kind() == CrsKind::local;
  throw Error(
      ErrorCode::usage,
      fmt::format("the maps have different CRSs: {} is in {}, {} in {}", name_a, a.crs.id(), name_b,
                  b.crs.id()),
      "",
      local ? "place the local map first: `waymark register`, or import its landmarks with --crs"
            : fmt::format("convert one first: `waymark export {} OTHER.gpkg --crs {}`", name_b, a.crs.id()));
}

/// Returns the time of the latest run of a map; empty if it has none.
std::string last_run(const LoadedMap& map) {
  return map.runs.empty() ? std::string() : map.runs.back().started_utc;
}

/// Adds the layer of changes between the maps that were merged, and their numbers.
void add_changes(std::pair<LoadedMap, LoadedMap> before, bool in_order, const JoinRecord& joined,
                 double max_move, LoadedMap& merged, MergeResult& result) {
  auto& [first, second] = before;
  adopt_types(first, merged.types);
  adopt_types(second, merged.types);
  std::vector<std::optional<std::size_t>> partners = joined.partners;
  if (!in_order) {
    partners.assign(first.landmarks.size(), {});
    for (std::size_t j = 0; j < joined.partners.size(); ++j)
      if (joined.partners[j]) partners[*joined.partners[j]] = j;
  }
  const LoadedMap &earlier = in_order ? first : second, &later = in_order ? second : first;
  const MapChanges found = find_changes(earlier, later, partners, max_move);
  const auto uid_of = [&](const MapChange& change) {
    const bool is_later = change.later.has_value();
    const std::size_t index = is_later ? *change.later : *change.earlier;
    return merged.landmarks[is_later == in_order ? joined.places[index] : index].uid;
  };
  add_layer(merged.layers, change_layer(found, earlier, later, uid_of));
  for (const MapChange& change : found.changes)
    ++(change.kind == ChangeKind::gone    ? result.gone
       : change.kind == ChangeKind::moved ? result.moved
                                          : result.appeared);
  result.unchanged = found.unchanged;
  result.not_covered = found.not_covered;
}

geodb::RunRecord merge_record(const std::vector<InputFile>& inputs, const LoadedMap& merged,
                              const MergeResult& counts, bool with_changes) {
  geodb::RunRecord run;
  run.version = program_version();
  run.command_line = "waymark merge";
  for (const InputFile& input : inputs) run.command_line += " " + input.path;
  run.started_utc = merged.runs.empty() ? "1970-01-01T00:00:00Z" : merged.runs.back().started_utc;
  using RunJson = nlohmann::ordered_json;
  RunJson maps = RunJson::array();
  for (const InputFile& input : inputs) maps.push_back(input.path);
  run.job_json = RunJson{{"merge", maps}}.dump();
  RunJson report{{"landmarks", counts.landmarks}, {"fused", counts.fused}, {"identical", counts.identical}};
  if (with_changes)
    report.update(RunJson{{"gone", counts.gone},
                          {"new", counts.appeared},
                          {"moved", counts.moved},
                          {"unchanged", counts.unchanged},
                          {"not_covered", counts.not_covered}});
  run.report_json = report.dump();
  run.inputs = inputs;
  return run;
}

/// Merges the whole maps aside and writes the part inside the area.
MergeResult merge_inside(const MergeRequest& request, const Callbacks& callbacks) try {
  area_of_map(request.aoi, request.maps.front());  // before any work
  const fs::path parent = fs::path(request.result).parent_path();
  const LockedFolder folder(parent.empty() ? fs::path(".") : parent);
  MergeRequest whole = request;
  whole.aoi.clear();
  whole.result = (folder.path() / fs::path(request.result).filename()).string();
  MergeResult result = merge_maps(whole, {callbacks.progress, [&](const Message& message) {
                                            if (message.kind != MessageKind::summary)
                                              callbacks.send(message.kind, message.text);
                                          }});
  std::vector<std::string> warnings;
  const std::int64_t all =
      std::exchange(result.landmarks, write_part_of_map(whole.result, request.aoi, request.result, warnings));
  for (const std::string& warning : warnings) callbacks.warning(warning);
  callbacks.summary(fmt::format("{}: {} of {} landmarks of {} maps lie in the area of interest\n",
                                request.result, result.landmarks, all, request.maps.size()));
  return result;
} catch (const fs::filesystem_error& e) {
  fail_output(request.result, e.code().message());
}

}  // namespace

MergeResult merge_maps(const MergeRequest& request, const Callbacks& callbacks) {
  check_request(request);
  if (!request.aoi.empty()) return merge_inside(request, callbacks);
  const std::vector<InputFile> inputs = sorted_inputs(request.maps);
  // Of two maps in the order of time: whether the sorted inputs are in that of the request.
  const bool in_order = inputs.front().path == request.maps.front();
  JoinRecord joined;
  LoadedMap merged = load_map(inputs.front().path);
  std::optional<std::pair<LoadedMap, LoadedMap>> before;
  for (std::size_t i = 1; i < inputs.size(); ++i) {
    LoadedMap next = load_map(inputs[i].path);
    check_crs(merged, inputs.front().path, next, inputs[i].path);
    if (request.changes) before.emplace(merged, next);
    const bool next_is_later = request.changes ? in_order : !(last_run(next) < last_run(merged));
    merged = join_maps(std::move(merged), std::move(next), next_is_later, joined);
  }
  drop_stand_ins(merged);
  MergeResult result{.landmarks = static_cast<std::int64_t>(merged.landmarks.size()),
                     .fused = joined.fused,
                     .identical = joined.identical,
                     .disagreeing = joined.moved};
  if (before) add_changes(std::move(*before), in_order, joined, request.max_move, merged, result);
  if (joined.moved > 0)
    callbacks.warning(fmt::format(
        "{} landmarks that identify themselves are elsewhere in each map: the position of {} counts",
        joined.moved, request.changes ? "the second map" : "the map with the latest run"));
  if (merged.has_elevations) callbacks.warning("the elevation tiles of the maps are left out");
  geodb::MapContents contents;
  contents.run = merge_record(inputs, merged, result, request.changes);
  contents.types = std::move(merged.types);
  contents.crs = merged.crs;
  contents.landmarks = std::move(merged.landmarks);
  contents.observations = std::move(merged.evidence);
  contents.images = std::move(merged.images);
  contents.layers = std::move(merged.layers);
  contents.earlier_runs = std::move(merged.runs);
  geodb::write_map(request.result, contents, {.empty_tables = contents.types.names()});
  callbacks.summary(fmt::format("{}: {} landmarks of {} maps; {} fused, {} identical\n", request.result,
                                result.landmarks, inputs.size(), result.fused, result.identical));
  if (request.changes)
    callbacks.summary(
        fmt::format("changes: {} gone, {} new, {} moved; {} unchanged, {} not covered by the other map\n",
                    result.gone, result.appeared, result.moved, result.unchanged, result.not_covered));
  return result;
}

}  // namespace waymark::workflows
