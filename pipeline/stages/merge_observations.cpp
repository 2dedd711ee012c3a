// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "geo/dem_handle.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"
#include "pipeline/fusion/association/merging.hpp"
#include "pipeline/fusion/cleaning/rejection_counter.hpp"

namespace waymark::pipeline {
namespace {

struct MergeObservations {
  struct Options {
    Meters max_distance{0};
    double position_gate = AssociationRules{}.position_gate;
    double size_gate = AssociationRules{}.size_gate;
    double overlap = AssociationRules{}.overlap;
    double common_fraction = MergeRules{}.common_fraction;
    std::string weights = "quality";
    void describe(OptionVisitor& option) {
      option("max_distance", max_distance,
             {.help = "Largest distance between observations of one landmark; 0: only covariances decide",
              .min = 0,
              .max = 1e7});
      option(
          "position_gate", position_gate,
          {.help =
               "Gate of the squared Mahalanobis distance between observations of one landmark (chi-square, 2 "
               "degrees of freedom)",
           .min = 0.1,
           .max = 1000});
      option("size_gate", size_gate,
             {.help = "Gate for the logarithm of the size (chi-square, 1 degree of freedom)",
              .min = 0.1,
              .max = 1000});
      option("overlap", overlap,
             {.help = "Bodies of similar size in different images, nearer than this fraction of their "
                      "radius, are one "
                      "regardless of covariances",
              .min = 0,
              .max = 2});
      option("common_fraction", common_fraction,
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
  static constexpr Gather<std::vector<Observation>> observations{"observations"};
  static constexpr Out<std::vector<Landmark>> merged{"merged"};
  static constexpr Out<std::vector<Observation>> merged_evidence{"merged_evidence"};

  static StageSpec spec() {
    return {.name = "merge_observations",
            .summary = "Merges observations of different images into landmarks",
            .version = 5,
            .scope = Scope::map,
            .inputs = {dem, observations},
            .outputs = {merged, merged_evidence}};
  }

  // Releases each part as soon as it is appended.
  static std::vector<Observation> concatenate(std::vector<std::vector<Observation>> parts) {
    std::size_t count = 0;
    for (const auto& part : parts) count += part.size();
    std::vector<Observation> all;
    all.reserve(count);
    for (auto& part : parts) std::ranges::move(std::exchange(part, {}), std::back_inserter(all));
    return all;
  }

  static void run(const Options& options, StageContext& unit) {
    const TypeRegistry& types = unit.types();
    std::vector<Observation> all = concatenate(unit.take_all(observations));
    MergeRules rules;
    rules.association.position_gate = options.position_gate;
    rules.association.size_gate = options.size_gate;
    rules.association.overlap = options.overlap;
    if (options.max_distance.value > 0) rules.association.max_distance = options.max_distance.value;
    rules.common_fraction = options.common_fraction;
    rules.weights = options.weights == "precision" ? FeatureWeights::precision : FeatureWeights::quality;
    std::sort(all.begin(), all.end(), comes_before);
    RejectionCounter count(unit, all);
    MergedObservations made =
        merge_observations(std::move(all), types, unit.read(dem)->geometry().where.crs, rules);
    count.close(made.evidence);
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
