// SPDX-License-Identifier: Apache-2.0
#include "geo/dem_handle.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/fusion/landmark_codec.hpp"
#include "pipeline/terrain/codecs.hpp"
#include "pipeline/terrain/mountain_tops.hpp"

namespace waymark {
namespace {

struct MapMountainTops {
  struct Options {
    Meters min_isolation{0};
    Meters visible_range{10000};
    void describe(OptionVisitor& option) {
      option("min_isolation", min_isolation,
             {.help = "Summits nearer than this to higher ground are left out", .min = 0, .max = 4e7});
      option("visible_range", visible_range,
             {.help = "How far around a summit its expected visibility is averaged", .min = 1, .max = 1e6});
    }
  };
  static constexpr In<DemHandle> dem{"dem"};
  static constexpr In<std::vector<Summit>> summits{"summits"};
  static constexpr In<std::vector<Isolation>> isolation{"summit_isolation"};
  static constexpr Out<std::vector<Landmark>> landmarks{"landmarks"};

  static StageSpec spec() {
    return {.name = "map_mountain_tops",
            .summary = "Makes landmarks of the summits: position, features, visibility, parents",
            .version = 1,
            .scope = Scope::map,
            .inputs = {dem, summits, isolation},
            .outputs = {landmarks},
            .finds = {"mountain_top"}};
  }

  static void run(const Options& options, StageContext& unit) {
    TypeRegistry types;
    register_landmark_types(types);
    const auto& found = unit.read(summits);
    auto tops =
        mountain_tops(found, unit.read(isolation), *unit.read(dem), types,
                      {.min_isolation = options.min_isolation, .visible_range = options.visible_range});
    unit.count_in(static_cast<std::int64_t>(found.size()));
    unit.count_out(static_cast<std::int64_t>(tops.size()));
    unit.reject("isolation too small", static_cast<std::int64_t>(found.size() - tops.size()));
    unit.write(landmarks, std::move(tops));
  }
};

}  // namespace

void register_stage_map_mountain_tops(Registry& registry);
void register_stage_map_mountain_tops(Registry& registry) {
  registry.add<MapMountainTops>();
}

}  // namespace waymark
