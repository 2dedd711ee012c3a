// SPDX-License-Identifier: Apache-2.0
// Adds a stage to the pipeline of mountain tops: it keeps the tops that stand far from any higher ground.
#include <iostream>
#include <waymark/map.hpp>
#include <waymark/mapping.hpp>
using namespace waymark;

namespace {

struct KeepIsolatedTops {
  struct Options {
    Meters min_isolation{1000};
    void describe(OptionVisitor& option) {
      option("min_isolation", min_isolation,
             {.help = "Distance to higher ground of the tops kept", .min = 0});
    }
  };
  static constexpr pipeline::In<std::vector<Landmark>> all{"landmarks"};
  static constexpr pipeline::Out<std::vector<Landmark>> kept{"isolated_tops"};
  static pipeline::StageSpec spec() {
    return {.name = "keep_isolated_tops",
            .summary = "Keeps tops far from higher ground",
            .inputs = {all},
            .outputs = {kept}};
  }
  static void run(const Options& options, pipeline::StageContext& unit) {
    TypeRegistry types;
    register_landmark_types(types);
    const std::size_t isolation = feature_index(types[types.id("mountain_top")], "isolation");
    std::vector<Landmark> tops;
    for (const Landmark& top : unit.read(all)) {
      unit.count_in(1);
      if (top.features[isolation].value < options.min_isolation.value)
        unit.reject("near higher ground");
      else
        tops.push_back(top), unit.count_out(1);
    }
    unit.write(kept, std::move(tops));
  }
};

}  // namespace

int main(int argc, char** argv) try {
  const std::string dem = argc > 1 ? argv[1] : "sample_data/jacksboro/dem.tif";
  pipeline::Registry stages;
  workflows::register_built_in_stages(stages);
  stages.add<KeepIsolatedTops>();
  pipeline::Pipeline mapping(stages);
  mapping.add("load_dem", R"({"files": [")" + dem + R"("], "nodata": "unknown"})").add("find_mountain_tops");
  mapping.add("join_mountain_tops").add("measure_isolation").add("map_mountain_tops");
  mapping.add<KeepIsolatedTops>({.min_isolation = 2000_m});
  const pipeline::RunResult result = pipeline::run(mapping);
  std::cout << result.report;  // with the tops rejected as "near higher ground"
  return result.artifact<std::vector<Landmark>>("isolated_tops").empty() ? 1 : 0;
} catch (const Error& error) {
  std::cerr << error.what() << '\n';
  return exit_code(error.code());
}
