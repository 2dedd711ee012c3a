// SPDX-License-Identifier: Apache-2.0
#include "landmarks/landmark_type.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/forest/crown_names.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"
#include "pipeline/fusion/association/merging.hpp"
#include "pipeline/fusion/valuation/area_filter.hpp"
#include "pipeline/fusion/valuation/landmark_valuation.hpp"

namespace waymark::pipeline {
namespace {

// Equivalent of merge_observations and value_flights for a single survey, where nothing is merged: tile by
// tile, so that not all trees are in memory.
struct TreesOfSurvey {
  struct Options {
    void describe(OptionVisitor&) {}
  };
  static constexpr In<Canopies> canopies{"canopies"};
  static constexpr In<std::vector<Observation>> observations{"observations"};
  static constexpr In<CrownTable> seen_crowns{"seen_crowns"};
  static constexpr Out<std::vector<Landmark>> landmarks{"landmarks"};
  static constexpr Out<std::vector<Observation>> evidence{"evidence"};
  static constexpr Out<CrownTable> crowns{"crowns"};

  static StageSpec spec() {
    return {.name = "trees_of_survey",
            .summary = "Converts the trees of one canopy model to landmarks and assigns their crowns",
            .version = 2,
            .scope = Scope::tile,
            .inputs = {canopies, observations, seen_crowns},
            .outputs = {landmarks, evidence, crowns}};
  }

  static void check_inputs(const Options&, StageContext& unit) {
    if (unit.has(canopies) && unit.read(canopies).size() != 1)
      throw Error(ErrorCode::usage, "trees of several surveys must be merged", "trees_of_survey",
                  "replace this stage by merge_observations and value_flights");
  }

  static void run(const Options& options, StageContext& unit) {
    check_inputs(options, unit);
    const Canopies& surveys = unit.read(canopies);
    const TypeRegistry& types = unit.types();
    MergeRules apart;
    apart.association.duplicate_overlap = 0;  // two tops of one canopy model are two trees
    MergedObservations made =
        merge_observations(unit.take(observations), types, surveys[0]->geometry().where.crs, apart);
    value_landmarks(made.landmarks, made.evidence, {}, nullptr, types, 1);
    unit.count_in(static_cast<std::int64_t>(made.landmarks.size()));
    unit.reject(kOutsideArea, remove_outside(made.landmarks, made.evidence,
                                             [&](double x, double y) { return surveys[0]->in_area(x, y); }));
    std::erase_if(made.evidence,
                  [](const Observation& o) { return !o.rejected.empty(); });  // as in other tiles
    unit.write(crowns, name_crowns({&unit.read(seen_crowns), 1}, made.evidence, made.landmarks));
    unit.count_out(static_cast<std::int64_t>(made.landmarks.size()));
    unit.write(landmarks, std::move(made.landmarks));
    unit.write(evidence, std::move(made.evidence));
  }
};

}  // namespace

void register_stage_trees_of_survey(Registry& registry);
void register_stage_trees_of_survey(Registry& registry) {
  registry.add<TreesOfSurvey>();
}

}  // namespace waymark::pipeline
