// SPDX-License-Identifier: Apache-2.0
#include "geo/dem_handle.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/fusion/valuation/landmark_valuation.hpp"
#include "pipeline/stages/valued_parts.hpp"

namespace waymark::pipeline {
namespace {

// Landmarks of a DEM alone: each source detected its own.
struct ValueSurveys {
  struct Options {
    void describe(OptionVisitor&) {}
  };
  static constexpr In<DemHandle> dem{"dem"};

  static StageSpec spec() {
    return {.name = "value_surveys",
            .summary = "Values landmarks without images; a DEM or a table is one survey",
            .version = 3,
            .scope = Scope::map,
            .inputs = {dem, ValuedParts::merged, ValuedParts::merged_evidence},
            .outputs = {ValuedParts::landmarks, ValuedParts::evidence, ValuedParts::rejected}};
  }

  static void run(const Options&, StageContext& unit) {
    const TypeRegistry& types = unit.types();
    const DemHandle& ground = unit.read(dem);
    ValuedParts::write(
        unit,
        [&](LandmarkList& all, ObservationList& seen) { value_landmarks(all, seen, {}, nullptr, types, 1); },
        [&](double x, double y) { return ground->in_area(x, y); });
  }
};

}  // namespace

void register_stage_value_surveys(Registry& registry);
void register_stage_value_surveys(Registry& registry) {
  registry.add<ValueSurveys>();
}

}  // namespace waymark::pipeline
