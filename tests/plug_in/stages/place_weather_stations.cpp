// SPDX-License-Identifier: Apache-2.0
#include "core/landmark.hpp"
#include "pipeline/engine/stage.hpp"
#include "tests/plug_in/stations.hpp"
namespace waymark::test {
namespace {

/// Places a station on each summit above the minimum elevation.
struct PlaceWeatherStations {
  struct Options {
    Meters min_elevation{500};
    void describe(OptionVisitor& option) {
      option("min_elevation", min_elevation,
             {.help = "Lowest summit that gets a station", .min = -500, .max = 9000});
    }
  };
  static constexpr pipeline::In<std::vector<Landmark>> summits{"landmarks"};
  static constexpr pipeline::Out<Stations> stations{"stations"};
  static pipeline::StageSpec spec() {
    return {.name = "place_weather_stations",
            .summary = "Puts weather stations on summits",
            .inputs = {summits},
            .outputs = {stations}};
  }
  static void run(const Options& options, pipeline::StageContext& unit) {
    Stations placed;
    const auto& tops = unit.read(summits);
    unit.count_in(std::ssize(tops));
    for (const Landmark& top : tops) {
      if (top.position.xyz.z() >= options.min_elevation.value)
        placed.uids.push_back(top.uid);
      else
        unit.reject("too low");
    }
    unit.count_out(std::ssize(placed.uids));
    unit.write(stations, std::move(placed));
  }
};

}  // namespace

void register_stage_place_weather_stations(pipeline::Registry& registry);
void register_stage_place_weather_stations(pipeline::Registry& registry) {
  registry.add<PlaceWeatherStations>();
}

}  // namespace waymark::test
