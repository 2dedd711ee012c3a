// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "landmarks/landmark_type.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/forest/crown_names.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"
#include "pipeline/fusion/valuation/area_filter.hpp"
#include "pipeline/fusion/valuation/landmark_valuation.hpp"

namespace waymark::pipeline {
namespace {

// A canopy model is a survey that could have shown a tree wherever the canopy's height is known.
struct ValueFlights {
  struct Options {
    void describe(OptionVisitor&) {}
  };
  static constexpr In<Canopies> canopies{"canopies"};
  static constexpr In<std::vector<Landmark>> merged{"merged"};
  static constexpr In<std::vector<Observation>> merged_evidence{"merged_evidence"};
  static constexpr In<CrownTable> seen_crowns{"seen_crowns"};
  static constexpr Out<std::vector<Landmark>> landmarks{"landmarks"};
  static constexpr Out<std::vector<Observation>> evidence{"evidence"};
  static constexpr Out<CrownTable> crowns{"crowns"};

  static StageSpec spec() {
    return {.name = "value_flights",
            .summary =
                "Values trees by the canopy models that show them and that could have; assigns their crowns",
            .version = 4,
            .scope = Scope::map,
            .inputs = {canopies, merged, merged_evidence, seen_crowns},
            .outputs = {landmarks, evidence, crowns}};
  }

  static void run(const Options&, StageContext& unit) {
    const TypeRegistry& types = unit.types();
    std::vector<Landmark> all = unit.take(merged);
    std::vector<Observation> seen = unit.take(merged_evidence);
    value_landmarks(all, seen, {}, nullptr, types, 1);
    const Canopies& surveys = unit.read(canopies);
    if (surveys.size() > 1) {
      for (Landmark& landmark : all) {
        landmark.quality.visible = std::max(landmark.quality.seen, count_covering(surveys, landmark));
        const int missed = landmark.quality.visible - landmark.quality.seen;
        landmark.confidence *= std::pow(kMissedFactor, missed);
      }
    }
    unit.count_in(static_cast<std::int64_t>(all.size()));
    unit.reject(kOutsideArea,
                remove_outside(all, seen, [&](double x, double y) { return surveys[0]->in_area(x, y); }));
    unit.write(crowns, name_crowns(unit.take_all(seen_crowns), seen, all));
    unit.count_out(static_cast<std::int64_t>(all.size()));
    unit.write(landmarks, std::move(all));
    unit.write(evidence, std::move(seen));
  }

  // Factor on the confidence of a tree for each survey that should show it but does not.
  static constexpr double kMissedFactor = 0.7;

  static int count_covering(const Canopies& surveys, const Landmark& landmark) {
    int count = 0;
    for (const auto& canopy : surveys) {
      const Georeference& where = canopy->geometry().where;
      const Window cell{std::llround(where.column(landmark.position.xyz.x())),
                        std::llround(where.row(landmark.position.xyz.y())), 1, 1};
      count += canopy->read(cell)(0, 0) != kNoCanopy;
    }
    return count;
  }
};

}  // namespace

void register_stage_value_flights(Registry& registry);
void register_stage_value_flights(Registry& registry) {
  registry.add<ValueFlights>();
}

}  // namespace waymark::pipeline
