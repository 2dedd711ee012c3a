// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "pipeline/engine/runner.hpp"

namespace waymark::pipeline {
namespace {

/// Returns the text quoted as one argument of a POSIX shell.
std::string quote_for_shell(const std::string& text) {
  if (!text.empty() &&
      text.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./-") ==
          std::string::npos)
    return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string run_command(const PlanCommand& command) {
  std::string call = fmt::format("{} run {} --work {}", quote_for_shell(command.program),
                                 quote_for_shell(command.job), quote_for_shell(command.work));
  for (const std::string& setting : command.settings) call += " --set " + quote_for_shell(setting);
  return call;
}

std::string map_command(const PlanCommand& command) {
  return fmt::format("{} -o {}", run_command(command), quote_for_shell(command.map));
}

/// Returns a Python string literal.
std::string python_string(const std::string& text) {
  return nlohmann::json(text).dump();
}

/// Returns a command as a Snakemake string, where braces are doubled.
std::string snakemake_shell(std::string command) {
  for (const char brace : {'{', '}'})
    for (std::size_t at = 0; (at = command.find(brace, at)) != std::string::npos; at += 2)
      command.insert(at, 1, brace);
  return python_string(command);
}

/// One job of a stage, or as many as it has shards.
struct StageJobs {
  std::size_t stage = 0;
  std::string name;
  std::set<std::size_t> after;  ///< stages
  std::size_t shards = 0;       ///< 0: one job
};

std::vector<StageJobs> stage_jobs(const Plan& plan) {
  constexpr std::size_t kMaxShards = 64;
  std::vector<StageJobs> all;
  for (std::size_t stage = 0; stage < plan.stage_count(); ++stage) {
    const std::size_t begin = plan.begins[stage], end = plan.begins[stage + 1];
    if (begin == end) continue;
    const Unit& first = plan.units[begin];
    StageJobs jobs{.stage = stage, .name = first.stage, .after = {}};
    for (const std::size_t read : first.after)
      jobs.after.insert(
          static_cast<std::size_t>(std::ranges::upper_bound(plan.begins, read) - plan.begins.begin()) - 1);
    if (first.index()) jobs.shards = std::min(end - begin, kMaxShards);
    all.push_back(std::move(jobs));
  }
  return all;
}

/// Returns the call of a job; `shard` stands for the number of the shard.
std::string job_command(const Plan& plan, const StageJobs& jobs, const PlanCommand& command,
                        const std::string& shard) {
  if (jobs.shards == 0)
    return fmt::format("{} --unit {}", run_command(command), plan.units[plan.begins[jobs.stage]].id());
  return fmt::format("{} --shard {}/{}", run_command(command), shard, jobs.shards);
}

std::string manifest(const Unit& unit, const PlanCommand& command) {
  return python_string(fmt::format("{}/{}/{}/manifest.json", command.work, unit.id(), unit.fingerprint));
}

}  // namespace

std::string plan_as_jsonl(const Plan& plan) {
  std::string lines;
  for (const Unit& unit : plan.units) {
    auto after = nlohmann::json::array();
    for (const std::size_t i : unit.after) after.push_back(plan.units[i].id());
    lines += nlohmann::ordered_json{{"unit", unit.id()}, {"stage", unit.stage},
                                    {"item", unit.item}, {"fingerprint", unit.fingerprint},
                                    {"done", unit.done}, {"after", std::move(after)}}
                 .dump() +
             "\n";
  }
  return lines;
}

std::string plan_as_snakemake(const Plan& plan, const PlanCommand& command) {
  const auto manifests = [&](const std::vector<std::size_t>& units) {
    std::vector<std::string> paths;
    for (const std::size_t i : units) paths.push_back(manifest(plan.units[i], command));
    return fmt::format("{}", fmt::join(paths, ",\n           "));
  };
  std::vector<std::size_t> all(plan.units.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  std::string text;
  if (command.map.empty())
    text = fmt::format("rule all:\n    input: {}\n", manifests(all));
  else
    text = fmt::format("rule map:\n    input: {}\n    output: {}\n    shell: {}\n", manifests(all),
                       python_string(command.map), snakemake_shell(map_command(command)));
  for (const Unit& unit : plan.units) {
    text += fmt::format("\nrule {}_{}:\n", unit.stage, unit.item);
    if (!unit.after.empty()) text += fmt::format("    input: {}\n", manifests(unit.after));
    text += fmt::format("    output: {}\n    shell: {}\n", manifest(unit, command),
                        snakemake_shell(fmt::format("{} --unit {}", run_command(command), unit.id())));
  }
  return text;
}

std::string plan_as_slurm(const Plan& plan, const PlanCommand& command) {
  std::string script =
      "#!/bin/sh\n# One job per stage; a stage over tiles or images is an array of shards.\nset -eu\n";
  const auto submit = [&](const std::string& variable, const std::string& name, const std::string& options,
                          const std::string& call) {
    script += fmt::format("{}=$(sbatch --parsable --job-name={}{} --wrap {})\n", variable, name, options,
                          quote_for_shell(call));
  };
  std::string all;
  for (const StageJobs& jobs : stage_jobs(plan)) {
    std::string options;
    for (const std::size_t earlier : jobs.after)
      options += fmt::format("{}$stage_{}", options.empty() ? " --dependency=afterok:" : ":", earlier);
    if (jobs.shards > 0) options += fmt::format(" --array=1-{}", jobs.shards);
    submit(fmt::format("stage_{}", jobs.stage), jobs.name, options,
           job_command(plan, jobs, command, "$SLURM_ARRAY_TASK_ID"));
    all += fmt::format(":$stage_{}", jobs.stage);
  }
  if (!command.map.empty()) submit("map", "map", " --dependency=afterok" + all, map_command(command));
  return script;
}

std::string plan_as_parallel(const Plan& plan, const PlanCommand& command) {
  std::string script =
      "#!/bin/sh\n# The shards of each stage run side by side, the stages in order.\nset -eu\n";
  for (const StageJobs& jobs : stage_jobs(plan))
    script += jobs.shards == 0 ? job_command(plan, jobs, command, "") + "\n"
                               : fmt::format("seq {} | parallel --halt now,fail=1 {}\n", jobs.shards,
                                             quote_for_shell(job_command(plan, jobs, command, "{}")));
  if (!command.map.empty()) script += map_command(command) + "\n";
  return script;
}

}  // namespace waymark::pipeline
