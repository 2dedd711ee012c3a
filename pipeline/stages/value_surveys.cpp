// SPDX-License-Identifier: Apache-2.0
#include "geo/dem_handle.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"
#include "pipeline/fusion/valuation/area_filter.hpp"
#include "pipeline/fusion/valuation/landmark_valuation.hpp"

namespace waymark::pipeline {
namespace {

// Landmarks of a DEM alone: each source detected its own.
struct ValueSurveys {
  struct Options {
    void describe(OptionVisitor&) {}
  };
  static constexpr In<DemHandle> dem{"dem"};
  static constexpr In<std::vector<Landmark>> merged{"merged"};
  static constexpr In<std::vector<Observation>> merged_evidence{"merged_evidence"};
  static constexpr Out<std::vector<Landmark>> landmarks{"landmarks"};
  static constexpr Out<std::vector<Observation>> evidence{"evidence"};

  static StageSpec spec() {
    return {.name = "value_surveys",
            .summary = "Values landmarks without images; a DEM or a table is one survey",
            .version = 2,
            .scope = Scope::map,
            .inputs = {dem, merged, merged_evidence},
            .outputs = {landmarks, evidence}};
  }

  static void run(const Options&, StageContext& unit) {
    const TypeRegistry& types = unit.types();
    std::vector<Landmark> all = unit.take(merged);
    std::vector<Observation> seen = unit.take(merged_evidence);
    value_landmarks(all, seen, {}, nullptr, types, 1);
    unit.count_in(static_cast<std::int64_t>(all.size()));
    const DemHandle& ground = unit.read(dem);
    unit.reject(kOutsideArea,
                remove_outside(all, seen, [&](double x, double y) { return ground->in_area(x, y); }));
    unit.count_out(static_cast<std::int64_t>(all.size()));
    unit.write(landmarks, std::move(all));
    unit.write(evidence, std::move(seen));
  }
};

}  // namespace

void register_stage_value_surveys(Registry& registry);
void register_stage_value_surveys(Registry& registry) {
  registry.add<ValueSurveys>();
}

}  // namespace waymark::pipeline
