// SPDX-License-Identifier: Apache-2.0
#include "landmarks/landmark_type.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/forest/crown_names.hpp"
#include "pipeline/fusion/detection_codec.hpp"
#include "pipeline/fusion/landmark_codec.hpp"
#include "pipeline/fusion/merging.hpp"
#include "pipeline/fusion/valuing.hpp"

namespace waymark {
namespace {

// What merge_observations and value_flights do, where nothing is to be merged: tile by tile, so that the
// trees need not be in memory all at once.
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
            .summary = "Makes each tree of one canopy model a landmark and names its crown",
            .version = 1,
            .scope = Scope::tile,
            .inputs = {canopies, observations, seen_crowns},
            .outputs = {landmarks, evidence, crowns}};
  }

  static void run(const Options&, StageContext& unit) {
    const Canopies& surveys = unit.read(canopies);
    if (surveys.size() != 1)
      throw Error(ErrorCode::usage, "trees of several surveys are to be merged", "trees_of_survey",
                  "in place of this stage, take merge_observations and value_flights");
    TypeRegistry types;
    register_landmark_types(types);
    MergeRules apart;
    apart.identity.twin = 0;  // two tops of one canopy model are two trees
    MergedObservations made =
        merge_observations(unit.take(observations), types, surveys[0]->geometry().where.crs, apart);
    value_landmarks(made.landmarks, made.evidence, {}, nullptr, types, 1);
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

}  // namespace waymark
