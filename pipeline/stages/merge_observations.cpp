// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "geo/dem_handle.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/fusion/association/merging_by_cells.hpp"

namespace waymark::pipeline {
namespace {

struct MergeObservations {
  struct Options {
    Meters max_distance{0};
    MergeRules rules = {};
    std::string weights = "quality";
    void describe(OptionVisitor& option) {
      option("max_distance", max_distance,
             {.help = "Largest distance between observations of one landmark; 0: only covariances decide",
              .min = 0,
              .max = 1e7});
      option(
          "position_gate", rules.association.position_gate,
          {.help =
               "Gate of the squared Mahalanobis distance between observations of one landmark (chi-square, 2 "
               "degrees of freedom)",
           .min = 0.1,
           .max = 1000});
      option("size_gate", rules.association.size_gate,
             {.help = "Gate for the logarithm of the size (chi-square, 1 degree of freedom)",
              .min = 0.1,
              .max = 1000});
      option("overlap", rules.association.overlap,
             {.help = "Bodies of similar size in different images, nearer than this fraction of their "
                      "radius, are one "
                      "regardless of covariances",
              .min = 0,
              .max = 2});
      option("common_fraction", rules.common_fraction,
             {.help = "Fraction of a position's variance common to all images (shape, light, DEM)",
              .min = 0,
              .max = 1,
              .formerly = "common_share"});
      option("weights", weights,
             {.help = "Weight of an observation in a merged feature: quality (eq. 3) or precision",
              .choices = {"quality", "precision"}});
    }
  };
  static constexpr In<DemHandle> dem{"dem"};
  static constexpr GatherStream<std::vector<Observation>> observations{"observations"};
  static constexpr Out<Parts<std::vector<Landmark>>> merged{"merged"};
  static constexpr Out<Parts<std::vector<Observation>>> merged_evidence{"merged_evidence"};

  static StageSpec spec() {
    return {.name = "merge_observations",
            .summary = "Merges observations of different images into landmarks",
            .version = 6,
            .scope = Scope::map,
            .inputs = {dem, observations},
            .outputs = {merged, merged_evidence}};
  }

  static void run(const Options& options, StageContext& unit) {
    MergeRules rules = options.rules;
    if (options.max_distance.value > 0) rules.association.max_distance = options.max_distance.value;
    rules.weights = options.weights == "precision" ? FeatureWeights::precision : FeatureWeights::quality;
    const auto readers = unit.readers(observations);
    const ObservationStream stream{[&](const auto& look) {
                                     for (const auto& read : readers) look(*read());
                                   },
                                   [&](const auto& take) { unit.consume(observations, take); }};
    CellRules cells{.scratch = unit.scratch(), .progress = [&](double done) { unit.progress(done); }};
    MergedParts made =
        merge_by_cells(stream, unit.types(), unit.read(dem)->geometry().where.crs, rules, cells);
    unit.count_in(made.in);
    unit.count_out(made.out);
    for (const auto& [reason, count] : made.rejected) unit.reject(reason, count);
    unit.write(merged, std::move(made.landmarks));
    unit.write(merged_evidence, std::move(made.evidence));
  }
};

}  // namespace

void register_stage_merge_observations(Registry& registry);
void register_stage_merge_observations(Registry& registry) {
  registry.add<MergeObservations>();
}

}  // namespace waymark::pipeline
