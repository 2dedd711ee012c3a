// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "geo/dem_handle.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/fusion/count_kept.hpp"
#include "pipeline/fusion/detection_codec.hpp"
#include "pipeline/fusion/landmark_codec.hpp"
#include "pipeline/fusion/merging.hpp"

namespace waymark {
namespace {

struct MergeObservations {
  struct Options {
    Meters max_distance{0};
    double position_gate = IdentityRules{}.position_gate;
    double size_gate = IdentityRules{}.size_gate;
    double overlap = IdentityRules{}.overlap;
    double common_share = MergeRules{}.common_share;
    std::string weights = "quality";
    void describe(OptionVisitor& option) {
      option("max_distance", max_distance,
             {.help = "Observations further apart are never one landmark; 0: their covariances alone decide",
              .min = 0,
              .max = 1e7});
      option("position_gate", position_gate,
             {.help = "Largest squared distance in standard deviations (chi-square of 2) of one landmark's "
                      "observations",
              .min = 0.1,
              .max = 1000});
      option("size_gate", size_gate,
             {.help = "The same for the logarithm of the size (chi-square of 1)", .min = 0.1, .max = 1000});
      option(
          "overlap", overlap,
          {.help = "Bodies of like size in different images, nearer than this share of their radius, are one "
                   "whatever the covariances say",
           .min = 0,
           .max = 2});
      option("common_share", common_share,
             {.help = "Share of a position's variance that more images do not reduce: shape, light, DEM",
              .min = 0,
              .max = 1});
      option("weights", weights,
             {.help = "What an observation counts in a merged feature: quality (eq. 3) or precision",
              .choices = {"quality", "precision"}});
    }
  };
  static constexpr In<DemHandle> dem{"dem"};
  static constexpr Gather<std::vector<Observation>> observations{"observations"};
  static constexpr Out<std::vector<Landmark>> merged{"merged"};
  static constexpr Out<std::vector<Observation>> merged_evidence{"merged_evidence"};

  static StageSpec spec() {
    return {.name = "merge_observations",
            .summary = "Makes one landmark of the observations of one thing in different images",
            .version = 4,
            .scope = Scope::map,
            .inputs = {dem, observations},
            .outputs = {merged, merged_evidence}};
  }

  // Part by part, each let go of at once.
  static std::vector<Observation> joined(std::vector<std::vector<Observation>> parts) {
    std::size_t count = 0;
    for (const auto& part : parts) count += part.size();
    std::vector<Observation> all;
    all.reserve(count);
    for (auto& part : parts) std::ranges::move(std::exchange(part, {}), std::back_inserter(all));
    return all;
  }

  static void run(const Options& options, StageContext& unit) {
    TypeRegistry types;
    register_landmark_types(types);
    std::vector<Observation> all = joined(unit.take_all(observations));
    MergeRules rules;
    rules.identity.position_gate = options.position_gate;
    rules.identity.size_gate = options.size_gate;
    rules.identity.overlap = options.overlap;
    if (options.max_distance.value > 0) rules.identity.max_distance = options.max_distance.value;
    rules.common_share = options.common_share;
    rules.weights = options.weights == "precision" ? FeatureWeights::precision : FeatureWeights::quality;
    std::sort(all.begin(), all.end(), comes_before);
    KeptCount count(unit, all);
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

}  // namespace waymark
