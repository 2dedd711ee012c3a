// SPDX-License-Identifier: Apache-2.0
#include "geo/dem_handle.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/terrain/codecs.hpp"

namespace waymark::pipeline {
namespace {

struct MeasureIsolation {
  struct Options {
    std::string isolation = "cell";
    std::string distance = "geodesic";
    void describe(OptionVisitor& option) {
      option("isolation", isolation,
             {.help = "End point of isolation: nearest higher cell, or interpolated point of equal elevation",
              .choices = {"cell", "contact"}});
      option("distance", distance,
             {.help = "Distances on the body's ellipsoid, or straight on a projected map",
              .choices = {"geodesic", "planar"}});
    }
  };
  static constexpr In<DemHandle> dem{"dem"};
  static constexpr In<std::vector<Summit>> summits{"summits"};
  static constexpr In<ReliefPyramid> relief{"relief"};
  static constexpr Out<std::vector<Isolation>> isolation_out{"summit_isolation"};

  static StageSpec spec() {
    return {.name = "measure_isolation",
            .summary = "Measures the distance of each summit to higher terrain",
            .version = 1,
            .scope = Scope::map,
            .inputs = {dem, summits, relief},
            .outputs = {isolation_out}};
  }

  static DistanceKind distance(const Options& options) {
    return options.distance == "planar" ? DistanceKind::planar : DistanceKind::geodesic;
  }

  static void check_inputs(const Options& options, StageContext& unit) {
    if (unit.has(dem)) check_distance(distance(options), unit.read(dem)->geometry());
  }

  static void run(const Options& options, StageContext& unit) {
    const auto& tops = unit.read(summits);
    std::vector<HighPoint> points;
    for (const Summit& top : tops) points.push_back({top.cell, top.height});
    unit.count_in(static_cast<std::int64_t>(tops.size()));
    unit.count_out(static_cast<std::int64_t>(tops.size()));
    unit.write(
        isolation_out,
        measure_isolation(points, *unit.read(dem), unit.read(relief),
                          {.end = options.isolation == "contact" ? IsolationEnd::contact : IsolationEnd::cell,
                           .distance = distance(options)},
                          [&](std::size_t done) {
                            unit.progress(static_cast<double>(done) / static_cast<double>(points.size()));
                          }));
  }
};

}  // namespace

void register_stage_measure_isolation(Registry& registry);
void register_stage_measure_isolation(Registry& registry) {
  registry.add<MeasureIsolation>();
}

}  // namespace waymark::pipeline
