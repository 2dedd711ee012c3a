// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/plan/planner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "pipeline/engine/sha256.hpp"
#include "pipeline/engine/step_options.hpp"

namespace waymark::pipeline {
namespace {

/// Returns the indices of all units that a unit reads, ascending.
std::vector<std::size_t> all_units_read(const Plan& plan, const std::vector<Wire>& wires,
                                        std::size_t position) {
  std::vector<std::size_t> read;
  for (const Wire& wire : wires) {
    const auto [first, last] = units_read(plan, wire, position);
    for (std::size_t i = first; i < last; ++i) read.push_back(i);
  }
  std::ranges::sort(read);
  read.erase(std::unique(read.begin(), read.end()), read.end());
  return read;
}

bool lists_images(const Pipeline& pipeline, const Unit& unit) {
  return std::ranges::any_of(pipeline.steps(), [&](const std::unique_ptr<Step>& step) {
    return step->spec().lists == Scope::image && step->spec().name == unit.stage;
  });
}

bool writes(const Step& step, const std::string& port) {
  return std::ranges::find(step.spec().outputs, port, &OutputPort::name) != step.spec().outputs.end();
}

}  // namespace

std::vector<Wire> stage_wires(const Pipeline& pipeline, std::size_t stage) {
  const StageSpec& spec = pipeline.steps()[stage]->spec();
  std::vector<Wire> wires;
  for (const InputPort& input : spec.inputs)
    for (std::size_t writer = 0; writer < stage; ++writer)
      if (const Step& step = *pipeline.steps()[writer]; writes(step, input.name))
        wires.push_back({.port = input.name,
                         .writer = writer,
                         .same_item = spec.scope != Scope::map && step.spec().scope == spec.scope,
                         .gathers = input.gathers,
                         .streams = input.streams});
  return wires;
}

std::pair<std::size_t, std::size_t> units_read(const Plan& plan, const Wire& wire, std::size_t position) {
  const std::size_t begin = plan.begins[wire.writer];
  if (wire.same_item) return {begin + position, begin + position + 1};
  return {begin, plan.begins[wire.writer + 1]};
}

std::vector<bool> runs_while_planning(const Pipeline& pipeline, const std::vector<std::vector<Wire>>& wires) {
  std::vector<bool> runs(wires.size());
  for (std::size_t stage = wires.size(); stage-- > 0;) {
    runs[stage] = runs[stage] || pipeline.steps()[stage]->spec().lists.has_value();
    if (!runs[stage]) continue;
    for (const Wire& wire : wires[stage]) runs[wire.writer] = true;
  }
  return runs;
}

void append_units(Plan& plan, const Pipeline& pipeline, const Items& items) {
  const std::size_t stage = plan.stage_count();
  const StageSpec& spec = pipeline.steps()[stage]->spec();
  const std::vector<Wire> wires = stage_wires(pipeline, stage);
  const auto append = [&](std::string item, std::size_t position) -> Unit& {
    return plan.units.emplace_back(Unit{.stage = spec.name,
                                        .item = std::move(item),
                                        .tile = {},
                                        .image = {},
                                        .fingerprint = {},
                                        .after = all_units_read(plan, wires, position)});
  };
  if (spec.scope == Scope::map) append("map", 0);
  if (spec.scope == Scope::tile)
    for (std::size_t i = 0; i < items.tiles.size(); ++i)
      append(fmt::format("tile_{:06}", items.tiles[i].index), i).tile = items.tiles[i];
  if (spec.scope == Scope::image)
    for (std::size_t i = 0; i < items.images.size(); ++i)
      append(unit_item(items.images[i]), i).image = items.images[i];
  plan.begins.push_back(plan.units.size());
}

std::string types_fingerprint(const TypeRegistry& types) {
  auto all = nlohmann::json::array();
  for (const LandmarkType& type : types) {
    auto columns = nlohmann::json::array();
    for (const FeatureSpec& f : type.features)
      columns.push_back(
          {f.name, static_cast<int>(f.scale), fmt::format("{} {}", f.min_value, f.max_value), f.reference});
    for (const AttributeSpec& a : type.attributes) columns.push_back({a.name, static_cast<int>(a.kind)});
    const ExistenceRules& e = type.existence;
    all.push_back({type.name, columns, to_string(type.evidence), type.body.feature,
                   type.body.radius_per_value, e.further_detection, e.missed_image, e.prior_penalty,
                   e.min_probability});
  }
  return sha256(all.dump());
}

struct UnitFingerprints::Key {
  nlohmann::json json;
};

UnitFingerprints::UnitFingerprints(const Plan& plan, const Pipeline& pipeline, const Step& step,
                                   const std::string& types)
    : plan_(&plan),
      pipeline_(&pipeline),
      key_(new Key{{{"stage", step.spec().name},
                    {"version", step.spec().version},
                    {"halo", step.spec().halo},
                    {"options", canonical_options(step)},
                    {"types", types}}}) {}
UnitFingerprints::~UnitFingerprints() = default;

std::string UnitFingerprints::of(const Unit& unit, const std::vector<InputFile>& files) {
  nlohmann::json& key = key_->json;
  key["item"] = unit.item;
  if (std::optional<Tile> tile = unit.tile) {
    tile->rank = 0;
    key["tile"] = Codec<std::vector<Tile>>::encode({*tile});
  }
  if (unit.image) key["image"] = unit.image->content;
  key["files"] = nlohmann::json::array();
  for (const InputFile& file : files) key["files"].push_back(file.sha256);
  key["reads"] = nlohmann::json::array();
  for (const std::size_t read : unit.after)
    if (!unit.image || !lists_images(*pipeline_, plan_->units[read]))
      key["reads"].push_back(plan_->units[read].fingerprint);
  return sha256(key.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)).substr(0, 32);
}

}  // namespace waymark::pipeline
