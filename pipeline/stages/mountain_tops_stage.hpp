// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <utility>
#include <vector>
#include "geo/dem_handle.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"
#include "pipeline/terrain/codecs.hpp"
#include "pipeline/terrain/mountain_tops.hpp"
namespace waymark::pipeline {

/// What the stages that convert summits to landmarks share: all of the map at once, or those of a tile.
struct MountainTopsStage {
  struct Options {
    MountainTopOptions tops;
    void describe(OptionVisitor& option) {
      option("min_isolation", tops.min_isolation,
             {.help = "Smallest isolation of a summit that is kept", .min = 0, .max = 4e7});
      option("visible_range", tops.visible_range,
             {.help = "Radius around a summit over which its expected visibility is averaged",
              .min = 1,
              .max = 1e6});
    }
  };
  static constexpr In<DemHandle> dem{"dem"};
  static constexpr In<std::vector<Summit>> summits{"summits"};
  static constexpr In<std::vector<Isolation>> isolation{"summit_isolation"};
  static constexpr Out<std::vector<Landmark>> landmarks{"landmarks"};

  static StageSpec spec(std::string name, std::string summary, int version, Scope scope) {
    return {.name = std::move(name),
            .summary = std::move(summary),
            .version = version,
            .scope = scope,
            .inputs = {dem, summits, isolation},
            .outputs = {landmarks},
            .finds = {"mountain_top"}};
  }

  static void write_landmarks(const Options& options, const Window& window, StageContext& unit) {
    MountainTops tops = mountain_tops(unit.read(summits), unit.read(isolation), *unit.read(dem), unit.types(),
                                      options.tops, window);
    auto count = static_cast<std::int64_t>(tops.landmarks.size());
    unit.count_out(count);
    for (const auto& [reason, rejected] : tops.rejected) {
      unit.reject(reason, rejected);
      count += rejected;
    }
    unit.count_in(count);
    unit.write(landmarks, std::move(tops.landmarks));
  }
};

}  // namespace waymark::pipeline
