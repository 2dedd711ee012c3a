// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/merge_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>

#include "core/error.hpp"
#include "geodb/write_map.hpp"
#include "importers/hash.hpp"
#include "workflows/mapping/join_maps.hpp"
#include "workflows/output_path.hpp"
#include "workflows/provenance.hpp"

namespace waymark::workflows {
namespace {

void check_request(const MergeRequest& request) {
  check_map_output(request.result);
  if (request.maps.size() < 2)
    throw Error(ErrorCode::usage, "a merge needs two maps or more", "",
                "waymark merge A.gpkg B.gpkg -o C.gpkg");
  std::error_code missing;
  for (const std::string& map : request.maps)
    if (std::filesystem::equivalent(map, request.result, missing))
      throw Error(ErrorCode::usage, "the result would replace a map that is merged", map,
                  "pass another file by -o");
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

geodb::RunRecord merge_record(const std::vector<InputFile>& inputs, const LoadedMap& merged,
                              const MergeResult& counts) {
  geodb::RunRecord run;
  run.version = program_version();
  run.command_line = "waymark merge";
  for (const InputFile& input : inputs) run.command_line += " " + input.path;
  run.started_utc = merged.runs.empty() ? "1970-01-01T00:00:00Z" : merged.runs.back().started_utc;
  using RunJson = nlohmann::ordered_json;
  RunJson maps = RunJson::array();
  for (const InputFile& input : inputs) maps.push_back(input.path);
  run.job_json = RunJson{{"merge", maps}}.dump();
  run.report_json =
      RunJson{{"landmarks", counts.landmarks}, {"fused", counts.fused}, {"identical", counts.identical}}
          .dump();
  run.inputs = inputs;
  return run;
}

}  // namespace

MergeResult merge_maps(const MergeRequest& request, const Callbacks& callbacks) {
  check_request(request);
  const std::vector<InputFile> inputs = sorted_inputs(request.maps);
  JoinCounts joined;
  LoadedMap merged = load_map(inputs.front().path);
  for (std::size_t i = 1; i < inputs.size(); ++i) {
    LoadedMap next = load_map(inputs[i].path);
    check_crs(merged, inputs.front().path, next, inputs[i].path);
    merged = join_maps(std::move(merged), std::move(next), joined);
  }
  drop_stand_ins(merged);
  const MergeResult result{.landmarks = static_cast<std::int64_t>(merged.landmarks.size()),
                           .fused = joined.fused,
                           .identical = joined.identical};
  if (merged.has_elevations) callbacks.warning("the elevation tiles of the maps are left out");
  geodb::MapContents contents;
  contents.run = merge_record(inputs, merged, result);
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
  return result;
}

}  // namespace waymark::workflows
