// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "apps/map_arguments.hpp"
#include "core/error.hpp"

namespace waymark::apps {
namespace {

pipeline::Shard parse_shard(const std::string& text) {
  pipeline::Shard shard;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%d/%d%c", &shard.index, &shard.count, &rest) != 2 || shard.index < 1 ||
      shard.index > shard.count)
    throw Error(ErrorCode::usage, "--shard must be I/N with 1 <= I <= N, is '" + text + "'", "",
                "e.g. --shard 3/8 for the third of eight shards");
  return shard;
}

class Run final : public Command {
 public:
  CommandSpec describe() override {
    std::vector<Argument> all{
        file_word("JOB.json", &job_, "Stages in order, each with its options; `waymark stages` lists them")};
    for (auto& argument : map_arguments(asked_)) all.push_back(argument);
    all.push_back(
        {"--set", "STAGE.OPTION=VALUE", &settings_, "Change an option of the job; may be repeated"});
    all.push_back(
        {"--shard", "I/N", &shard_, "Run the I-th of N shards; all shards use the same --work folder"});
    all.push_back({"--stage", "NAME", &asked_.request.run.stage,
                   "Run this stage only, or with --shard its units of the shard; other results are reused"});
    all.push_back(
        {"--unit", "ID", &asked_.request.run.unit, "Run this unit of work only; `waymark plan` lists them"});
    all.push_back({"--confined", "", &confined_, "Refuse a job that names files outside its folder"});
    return {
        .name = "run",
        .group = Group::make,
        .summary = "Run a job file and write the map",
        .about =
            "Paths in the job file start at its folder. With --work every finished unit of work is kept "
            "under a fingerprint of its options and inputs: a second run does only what is missing or has "
            "changed.",
        .arguments = all,
        .examples = {{"waymark run job.json -o map.gpkg --work work",
                      "Run so that an interrupted run can be resumed"},
                     {"waymark run job.json -o map.gpkg --set find_mountain_tops.min_prominence=50",
                      "The same job with another threshold"},
                     {"waymark run job.json --check", "Check the job without running it"},
                     {"waymark run job.json --work /shared/work --shard 3/8", "The third of eight machines"},
                     {"waymark run job.json --work /shared/work --stage rocks_from_shadows --shard 3/8",
                      "The third of eight shards of one stage"}},
        .result = map_result_keys()};
  }

  int run(const Session& session) override {
    const pipeline::Job job = workflows::load_job(job_, settings_, confined_);
    if (!shard_.empty()) asked_.request.run.shard = parse_shard(shard_);
    return make_map_command(job, asked_, session);
  }

 private:
  std::string job_, shard_;
  std::vector<std::string> settings_;
  bool confined_ = false;
  MapCommand asked_;
};

}  // namespace

void register_command_run(CommandTable& commands);
void register_command_run(CommandTable& commands) {
  commands.add<Run>();
}

}  // namespace waymark::apps
