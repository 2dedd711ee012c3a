// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/planner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>

#include "pipeline/engine/option_table.hpp"
#include "pipeline/engine/sha256.hpp"

namespace waymark {
namespace {

/// The units a unit reads: of each input the one of the same tile, the only one, or all.
std::vector<std::size_t> units_read(const Plan& plan, const Pipeline& pipeline,
                                    const std::vector<Wire>& wires, std::size_t position) {
  std::vector<std::size_t> read;
  for (const Wire& wire : wires) {
    const std::size_t begin = plan.begins[wire.writer], end = plan.begins[wire.writer + 1];
    const bool same_tile = !wire.all_tiles && pipeline.steps()[wire.writer]->spec().scope == Scope::tile;
    if (same_tile) read.push_back(begin + position);
    if (same_tile) continue;
    read.resize(read.size() + (end - begin));
    std::iota(read.end() - static_cast<std::ptrdiff_t>(end - begin), read.end(), begin);
  }
  std::ranges::sort(read);
  read.erase(std::ranges::unique(read).begin(), read.end());
  return read;
}

}  // namespace

std::vector<Wire> wires_of(const Pipeline& pipeline, std::size_t stage) {
  const StageSpec& spec = pipeline.steps()[stage]->spec();
  std::vector<Wire> wires;
  for (const InputPort& input : spec.inputs) {
    const Step* writer = pipeline.writer_of(input.name);
    const auto at = std::ranges::find(pipeline.steps(), writer, &std::unique_ptr<Step>::get);
    wires.push_back({.port = input.name,
                     .writer = static_cast<std::size_t>(at - pipeline.steps().begin()),
                     .all_tiles = spec.scope == Scope::map && writer->spec().scope == Scope::tile});
  }
  return wires;
}

void append_units(Plan& plan, const Pipeline& pipeline, const std::vector<Tile>& tiles) {
  const std::size_t stage = plan.stage_count();
  const StageSpec& spec = pipeline.steps()[stage]->spec();
  const std::vector<Wire> wires = wires_of(pipeline, stage);
  const auto append = [&](std::string item, std::optional<Tile> tile, std::size_t position) {
    plan.units.push_back({.stage = spec.name,
                          .item = std::move(item),
                          .tile = tile,
                          .fingerprint = {},
                          .after = units_read(plan, pipeline, wires, position)});
  };
  if (spec.scope == Scope::map) append("map", {}, 0);
  if (spec.scope == Scope::tile)
    for (std::size_t i = 0; i < tiles.size(); ++i)
      append(fmt::format("tile_{:06}", tiles[i].index), tiles[i], i);
  plan.begins.push_back(plan.units.size());
}

std::string fingerprint_of(const Plan& plan, const Unit& unit, const Step& step,
                           const std::vector<InputFile>& files) {
  auto key = nlohmann::json{{"stage", unit.stage},
                            {"version", step.spec().version},
                            {"halo", step.spec().halo},
                            {"options", canonical_options(step)},
                            {"item", unit.item},
                            {"files", nlohmann::json::array()},
                            {"reads", nlohmann::json::array()}};
  if (unit.tile) key["tile"] = Codec<std::vector<Tile>>::encode({*unit.tile});
  for (const InputFile& file : files) key["files"].push_back(file.sha256);
  for (const std::size_t read : unit.after) key["reads"].push_back(plan.units[read].fingerprint);
  return sha256(key.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)).substr(0, 32);
}

}  // namespace waymark
