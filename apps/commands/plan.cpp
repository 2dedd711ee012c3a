// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/runner.hpp"

#include <iostream>

#include "apps/command.hpp"
#include "apps/console.hpp"
#include "workflows/mapping/make_map.hpp"
#include "workflows/output_path.hpp"

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
            "Each unit is one stage on one tile or on the whole map, with the units it waits for. Machines "
            "that share the --work folder need share nothing else.",
        .arguments = {file_word("JOB.json", &job_, "Job file"),
                      Argument{"--as", "FORM", &as_,
                               "JSON lines, a Snakefile, or a script of sbatch calls or of GNU parallel"}
                          .one_of({"jsonl", "snakemake", "slurm", "parallel"})
                          .or_else("jsonl"),
                      Argument{"--work", "DIR", &work_, "Folder all units share"}
                          .offering(Offer::folder)
                          .or_else("work"),
                      Argument{"-o,--output", "MAP.gpkg", &map_, "Map that the last call of the plan writes"}
                          .offering(Offer::file),
                      {"--set", "STAGE.OPTION=VALUE", &settings_,
                       "Change an option of the job; may be repeated"}},
        .examples = {{"waymark plan job.json --as jsonl", "One unit per line, done or not"},
                     {"waymark plan job.json --as snakemake -o map.gpkg > Snakefile && snakemake -j 8",
                      "Run by Snakemake"},
                     {"waymark plan job.json --as slurm -o map.gpkg | sh", "Run on a Slurm cluster"},
                     {"waymark plan job.json --as parallel -o map.gpkg | sh", "Run by GNU parallel"}}};
  }

  int run(const Session& session) override {
    if (!map_.empty()) workflows::check_map_output(map_);
    const pipeline::Job job = workflows::load_job(job_, settings_);
    const workflows::MapRequest request{.work = work_, .threads = static_cast<int>(session.threads)};
    const workflows::Callbacks callbacks = console_callbacks(session);
    for (const std::string& warning : job.pipeline.warnings()) callbacks.warning(warning);
    const pipeline::Plan units = pipeline::plan(job.pipeline, workflows::run_options(request, callbacks));
    const pipeline::PlanCommand call{.job = job_, .work = work_, .settings = settings_, .map = map_};
    std::cout << (as_ == "snakemake"  ? pipeline::plan_as_snakemake(units, call)
                  : as_ == "slurm"    ? pipeline::plan_as_slurm(units, call)
                  : as_ == "parallel" ? pipeline::plan_as_parallel(units, call)
                                      : pipeline::plan_as_jsonl(units));
    return 0;
  }

 private:
  std::string job_, as_ = "jsonl", work_ = "work", map_;
  std::vector<std::string> settings_;
};

}  // namespace

void register_command_plan(CommandTable& commands);
void register_command_plan(CommandTable& commands) {
  commands.add<PlanJob>();
}

}  // namespace waymark::apps
