// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/runner.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iostream>

#include "apps/command.hpp"
#include "apps/console.hpp"
#include "core/error.hpp"
#include "workflows/call_resources.hpp"
#include "workflows/mapping/call_costs.hpp"
#include "workflows/mapping/make_map.hpp"
#include "workflows/output_path.hpp"
#include "workflows/registries.hpp"
#include "workflows/sensor_file.hpp"

namespace waymark::apps {
namespace {

class PlanJob final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "plan",
        .group = Group::make,
        .summary = "Print the units of work of a job, for a scheduler",
        .about =
            "Each unit is one stage on one tile or on the whole map, with the units it waits for. For a "
            "scheduler the units of a stage are divided into shards, one call each. Machines that share the "
            "--work folder need share nothing else.",
        .arguments =
            {file_word("JOB.json", &job_, "Job file"),
             Argument{"--format", "FORMAT", &format_,
                      "JSON lines, a Snakefile, or a script of sbatch calls or of GNU parallel"}
                 .one_of({"jsonl", "snakemake", "slurm", "parallel"})
                 .or_else("jsonl")
                 .also("--as"),
             Argument{"--work", "DIR", &work_, "Folder all units share"}
                 .offering(Offer::folder)
                 .or_else("work"),
             Argument{"-o,--output", "MAP.gpkg", &map_, "Map that the last call of the plan writes"}.offering(
                 Offer::file),
             Argument{"--sensor", "NAME|FILE", &sensor_,
                      "Sensor profile that the last call of the plan records in the map"}
                 .offering(workflows::all_sensors().names()),
             Argument{"--shards", "N", &shards_, "Most calls per stage: arrays of a site are limited"}
                 .or_else("64"),
             {"--resources", "measured|[STAGE:]cpus=N,memory=G,time=MIN", &resources_,
              "Processors, memory and time that each call asks for; with STAGE or `map` those of one stage. "
              "measured: by what runs with this --work folder took. May be repeated"},
             {"--set", "STAGE.OPTION=VALUE", &settings_, "Change an option of the job; may be repeated"},
             {"--confined", "", &confined_, "Refuse a job that names files outside its folder"}},
        .examples = {
            {"waymark plan job.json --format jsonl", "One unit per line, done or not"},
            {"waymark plan job.json --format snakemake -o map.gpkg > Snakefile && snakemake -j 8",
             "Run by Snakemake"},
            {"waymark plan job.json --format slurm -o map.gpkg --resources cpus=1,memory=2G,time=60 "
             "--resources "
             "map:memory=8G | sh",
             "Run on a Slurm cluster"},
            {"waymark plan job.json --format slurm -o map.gpkg --resources measured --resources time=4h",
             "Ask for what a run of a part of the data took, and for four hours"},
            {"waymark plan job.json --format parallel -o map.gpkg | sh", "Run by GNU parallel"}}};
  }

  int run(const Session& session) override {
    if (shards_ < 1)
      throw Error(ErrorCode::usage, fmt::format("--shards {} leaves no call for a stage", shards_), "",
                  "give 1 or more");
    if (!sensor_.empty()) static_cast<void>(workflows::find_sensor(sensor_));
    if (!sensor_.empty() && map_.empty())
      throw Error(ErrorCode::usage, "--sensor is recorded in a map, but the plan writes none",
                  "--sensor " + sensor_, "pass -o MAP.gpkg");
    if (!map_.empty()) workflows::check_map_output(map_);
    const pipeline::Job job = workflows::load_job(job_, settings_, confined_);
    const workflows::MapRequest request{.run = {.work = work_, .threads = static_cast<int>(session.threads)}};
    const workflows::Callbacks callbacks = console_callbacks(session);
    for (const std::string& warning : job.pipeline.warnings()) callbacks.warning(warning);
    const pipeline::Plan units = pipeline::plan(job.pipeline, workflows::run_options(request, callbacks));
    const auto measured = take_measured(units, callbacks);
    const pipeline::PlanCommand call{
        .job = job_,
        .work = work_,
        .options = options_of_calls(session),
        .settings = settings_,
        .map = map_,
        .sensor = sensor_,
        .confined = confined_,
        .max_shards = static_cast<std::size_t>(shards_),
        .resources = workflows::parse_resources(resources_, stages_of(units), measured)};
    std::cout << (format_ == "snakemake"  ? pipeline::plan_as_snakemake(units, call)
                  : format_ == "slurm"    ? pipeline::plan_as_slurm(units, call)
                  : format_ == "parallel" ? pipeline::plan_as_parallel(units, call)
                                          : pipeline::plan_as_jsonl(units));
    return 0;
  }

 private:
  /// Removes the word `measured` of --resources; returns what it stands for.
  std::map<std::string, pipeline::CallResources> take_measured(const pipeline::Plan& units,
                                                               const workflows::Callbacks& callbacks) {
    if (std::erase(resources_, "measured") == 0) return {};
    workflows::MeasuredResources found =
        workflows::measured_resources(work_, units, static_cast<std::size_t>(shards_));
    if (map_.empty()) std::erase(found.unknown, "map");
    if (!found.unknown.empty())
      callbacks.warning(
          fmt::format("no run with --work {} measured {}: their calls ask for what else --resources says",
                      work_, fmt::join(found.unknown, ", ")));
    return std::move(found.by_stage);
  }
  /// Without these a call would open other files than the plan, or none.
  static std::vector<std::string> options_of_calls(const Session& session) {
    std::vector<std::string> words;
    if (session.allow_network) words.emplace_back("--allow-network");
    for (const std::string& setting : session.gdal_config) words.insert(words.end(), {"--config", setting});
    for (const std::string& file : session.plug_ins) words.insert(words.end(), {"--plugin", file});
    return words;
  }
  static std::vector<std::string> stages_of(const pipeline::Plan& plan) {
    std::vector<std::string> names;
    for (std::size_t stage = 0; stage < plan.stage_count(); ++stage)
      if (plan.begins[stage] < plan.begins[stage + 1]) names.push_back(plan.units[plan.begins[stage]].stage);
    return names;
  }

  std::string job_, format_ = "jsonl", work_ = "work", map_, sensor_;
  long shards_ = 64;
  std::vector<std::string> settings_, resources_;
  bool confined_ = false;
};

}  // namespace

void register_command_plan(CommandTable& commands);
void register_command_plan(CommandTable& commands) {
  commands.add<PlanJob>();
}

}  // namespace waymark::apps
