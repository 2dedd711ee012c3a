// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/stage.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"
#include "pipeline/fusion/cleaning/rejection_counter.hpp"
#include "pipeline/fusion/cleaning/rejections.hpp"

namespace waymark::pipeline {
namespace {

struct RejectImplausible {
  struct Options {
    PlausibilityRules rules = {};
    void describe(OptionVisitor& option) {
      option("min_depth_ratio", rules.min_depth_ratio,
             {.help = "Smallest depth / diameter of a crater whose depth the DEM resolves",
              .min = 0,
              .max = 0.5});
      option("max_height_ratio", rules.max_height_ratio,
             {.help = "Largest height / diameter of a rock; higher ones are cliffs and ridges",
              .min = 0.5,
              .max = 100});
    }
  };
  static constexpr In<std::vector<Observation>> placed{"placed"};
  static constexpr Out<std::vector<Observation>> plausible{"plausible"};

  static StageSpec spec() {
    return {.name = "reject_implausible",
            .summary = "Rejects observations whose features are outside the ranges of their type",
            .version = 1,
            .scope = Scope::image,
            .inputs = {placed},
            .outputs = {plausible}};
  }

  static void run(const Options& options, StageContext& unit) {
    const TypeRegistry& types = unit.types();
    std::vector<Observation> all = unit.read(placed);
    RejectionCounter count(unit, all);
    reject_implausible(all, types, options.rules);
    count.close(all);
    unit.write(plausible, std::move(all));
  }
};

}  // namespace

void register_stage_reject_implausible(Registry& registry);
void register_stage_reject_implausible(Registry& registry) {
  registry.add<RejectImplausible>();
}

}  // namespace waymark::pipeline
