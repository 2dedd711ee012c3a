// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/make_map.hpp"
#include "apps/registries.hpp"
#include "apps/stage_options.hpp"
#include "pipeline/craters/dem_blocks.hpp"

namespace waymark {
namespace {

class Craters final : public Command {
 public:
  CommandSpec describe() override {
    std::vector<Argument> all{Argument{
        "--dem", "DEM...", &files_, "Elevation models that GDAL opens; where they overlap the first counts"}
                                  .needed()
                                  .offering(Offer::file)};
    for (auto& argument : map_arguments(request_)) all.push_back(argument);
    for (auto& argument : options_.arguments()) all.push_back(argument);
    all.push_back({"--print-job", "", &print_job_,
                   "Print the job instead of running it: the start of one of your own"});
    return {.name = "craters",
            .group = Group::make,
            .summary = "Find the craters of a DEM",
            .about =
                "Dishes with rims are sought in the heights at every size from --min-diameter to "
                "--max-diameter cells; each gets its ellipse, depth, rim height and a probability. "
                "Craters of images: `waymark detect craters`, or a job with craters_from_bowls.",
            .arguments = all,
            .examples = {{"waymark craters --dem gld100.tif -o craters.gpkg", "A map of the Moon's craters"},
                         {"waymark craters --dem ctx_dtm.tif -o craters.gpkg --min-confidence 0.8",
                          "The surer ones only"},
                         {"waymark craters --dem mola.tif --print-job > job.json",
                          "The job, to change it and `waymark run` it"}}};
  }

  int run(const Session& session) override {
    const Job job = make_job();
    if (!print_job_) return make_map(job, request_, run_options(session), session);
    std::cout << job_as_json(job.name, job.pipeline) << '\n';
    return 0;
  }

 private:
  Job make_job() const {
    Pipeline pipeline(all_stages());
    pipeline.add("load_dem",
                 nlohmann::json{{"files", files_}, {"nodata", "unknown"}, {"tile_cells", kDemCore}}.dump());
    for (const char* stage : {"craters_from_dem", "merge_observations", "value_surveys"}) pipeline.add(stage);
    options_.apply(pipeline);
    return {"craters", std::move(pipeline)};
  }

  std::vector<std::string> files_;
  MapRequest request_;
  StageOptions options_{{"craters_from_dem.min_diameter", "craters_from_dem.max_diameter",
                         "craters_from_dem.min_confidence", "load_dem.crs", "load_dem.tile_cells",
                         "load_dem.memory"}};
  bool print_job_ = false;
};

}  // namespace

void register_command_craters(CommandTable& commands);
void register_command_craters(CommandTable& commands) {
  commands.add<Craters>();
}

}  // namespace waymark
