// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "apps/level_ground.hpp"
#include "apps/make_map.hpp"
#include "apps/registries.hpp"
#include "core/error.hpp"

namespace waymark {
namespace {

Shard shard_of(const std::string& text) {
  Shard shard;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%d/%d%c", &shard.index, &shard.count, &rest) != 2 || shard.index < 1 ||
      shard.index > shard.count)
    throw Error(ErrorCode::usage, "--shard must be I/N with 1 <= I <= N, is '" + text + "'", "",
                "e.g. --shard 3/8 for the third of eight shares");
  return shard;
}

class Run final : public Command {
 public:
  CommandSpec describe() override {
    std::vector<Argument> all{
        file_word("JOB.json", &job_, "Stages in order, each with its options; `waymark stages` lists them")};
    for (auto& argument : map_arguments(request_)) all.push_back(argument);
    all.push_back(
        {"--set", "STAGE.OPTION=VALUE", &settings_, "Change an option of the job; may be repeated"});
    all.push_back(
        {"--shard", "I/N", &shard_, "Do the I-th of N shares; all shares use the same --work folder"});
    all.push_back({"--unit", "ID", &unit_, "Do this unit of work only; `waymark plan` lists them"});
    return {
        .name = "run",
        .group = Group::make,
        .summary = "Run a job file and write the map",
        .about =
            "Paths in the job file start at its folder. With --work every finished unit of work is kept "
            "under a fingerprint of its options and inputs: a second run does only what is missing or has "
            "changed.",
        .arguments = all,
        .examples = {
            {"waymark run job.json -o map.gpkg --work work", "Run, and be able to go on after a stop"},
            {"waymark run job.json -o map.gpkg --set find_mountain_tops.min_prominence=50",
             "The same job with another threshold"},
            {"waymark run job.json --check", "Is the job sound?"},
            {"waymark run job.json --work /shared/work --shard 3/8", "The third of eight machines"}}};
  }

  int run(const Session& session) override {
    Job job = read_job(job_, all_stages());
    ask_for_metres(job.pipeline);
    for (const std::string& setting : settings_) job.pipeline.set(setting);
    RunOptions options = run_options(session);
    if (!shard_.empty()) options.shard = shard_of(shard_);
    options.unit = unit_;
    return make_map(job, request_, options, session);
  }

 private:
  std::string job_, shard_, unit_;
  std::vector<std::string> settings_;
  MapRequest request_;
};

}  // namespace

void register_command_run(CommandTable& commands);
void register_command_run(CommandTable& commands) {
  commands.add<Run>();
}

}  // namespace waymark
