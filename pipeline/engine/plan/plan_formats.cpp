// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "pipeline/engine/runner.hpp"
#include "pipeline/engine/sha256.hpp"

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

/// Returns the text as a JSON string.
std::string quote_for_json(const std::string& text) {
  const bool is_plain = std::ranges::all_of(
      text, [](unsigned char c) { return c >= ' ' && c < 0x7f && c != '"' && c != '\\'; });
  return is_plain ? '"' + text + '"' : nlohmann::json(text).dump();
}

constexpr const char* kMapCall = "map";

CallResources resources_of(const PlanCommand& command, const std::string& stage) {
  for (const std::string& name : {stage, std::string()})
    if (const auto found = command.resources.find(name); found != command.resources.end())
      return found->second;
  return {};
}

std::string run_command(const PlanCommand& command, const std::string& stage) {
  std::string call = fmt::format("{} run {} --work {}", quote_for_shell(command.program),
                                 quote_for_shell(command.job), quote_for_shell(command.work));
  for (const std::string& word : command.options) call += " " + quote_for_shell(word);
  for (const std::string& setting : command.settings) call += " --set " + quote_for_shell(setting);
  if (command.confined) call += " --confined";
  if (const int threads = resources_of(command, stage).processors; threads > 0)
    call += fmt::format(" --threads {}", threads);
  return call;
}

/// Returns the options of sbatch.
std::string sbatch_options(const CallResources& asked) {
  std::string options;
  if (asked.processors > 0) options += fmt::format(" --cpus-per-task={}", asked.processors);
  if (asked.megabytes > 0) options += fmt::format(" --mem={}M", asked.megabytes);
  if (asked.minutes > 0) options += fmt::format(" --time={}", asked.minutes);
  return options;
}

/// Returns the lines of a Snakemake rule.
std::string snakemake_resources(const CallResources& asked) {
  std::string lines, resources;
  if (asked.processors > 0) lines += fmt::format("    threads: {}\n", asked.processors);
  if (asked.megabytes > 0) resources += fmt::format("mem_mb={}", asked.megabytes);
  if (asked.minutes > 0)
    resources += fmt::format("{}runtime={}", resources.empty() ? "" : ", ", asked.minutes);
  return resources.empty() ? lines : lines + "    resources: " + resources + "\n";
}

/// Returns the options of GNU parallel, which counts processors by jobs and starts none without free memory.
std::string parallel_options(const CallResources& asked) {
  std::string options;
  if (asked.processors > 1) options += fmt::format(" --jobs {}%", std::max(1, 100 / asked.processors));
  if (asked.megabytes > 0) options += fmt::format(" --memfree {}M", asked.megabytes);
  if (asked.minutes > 0) options += fmt::format(" --timeout {}", 60 * asked.minutes);
  return options;
}

std::string map_command(const PlanCommand& command) {
  const std::string sensor =
      command.sensor.empty() ? "" : fmt::format(" --sensor {}", quote_for_shell(command.sensor));
  return fmt::format("{}{} -o {}", run_command(command, kMapCall), sensor, quote_for_shell(command.map));
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

std::vector<StageJobs> stage_jobs(const Plan& plan, const PlanCommand& command) {
  std::vector<StageJobs> all;
  for (std::size_t stage = 0; stage < plan.stage_count(); ++stage) {
    const std::size_t begin = plan.begins[stage], end = plan.begins[stage + 1];
    if (begin == end) continue;
    const Unit& first = plan.units[begin];
    StageJobs jobs{.stage = stage, .name = first.stage, .after = {}};
    for (const std::size_t read : first.after)
      jobs.after.insert(
          static_cast<std::size_t>(std::ranges::upper_bound(plan.begins, read) - plan.begins.begin()) - 1);
    if (first.index()) jobs.shards = std::min(end - begin, command.max_shards);
    all.push_back(std::move(jobs));
  }
  return all;
}

/// Returns the call of a job; `shard` stands for the number of the shard.
std::string job_command(const StageJobs& jobs, const PlanCommand& command, const std::string& shard) {
  const std::string call = fmt::format("{} --stage {}", run_command(command, jobs.name), jobs.name);
  return jobs.shards == 0 ? call : fmt::format("{} --shard {}/{}", call, shard, jobs.shards);
}

/// Returns the names of the empty files that mark the finished shards of a job; {shard} stands for the
/// number. They differ where any result of the stage does.
std::string shard_mark(const Plan& plan, const StageJobs& jobs, const PlanCommand& command) {
  std::string fingerprints;
  for (std::size_t i = plan.begins[jobs.stage]; i < plan.begins[jobs.stage + 1]; ++i)
    fingerprints += plan.units[i].fingerprint;
  const std::string stem =
      fmt::format("{}/shards/{}-{}", command.work, jobs.name, sha256(fingerprints).substr(0, 16));
  return jobs.shards == 0 ? stem : fmt::format("{}/{{shard}}_of_{}", stem, jobs.shards);
}

/// Returns the marks of all shards of a job as an input of a Snakemake rule.
std::string all_marks(const Plan& plan, const StageJobs& jobs, const PlanCommand& command) {
  const std::string mark = python_string(shard_mark(plan, jobs, command));
  return jobs.shards == 0 ? mark : fmt::format("expand({}, shard=range(1, {}))", mark, jobs.shards + 1);
}

}  // namespace

std::string plan_as_jsonl(const Plan& plan) {
  std::string lines;
  auto line = std::back_inserter(lines);
  for (const Unit& unit : plan.units) {
    fmt::format_to(line, R"({{"unit":{},"stage":{},"item":{},"fingerprint":"{}","done":{},"after":[)",
                   quote_for_json(unit.id()), quote_for_json(unit.stage), quote_for_json(unit.item),
                   unit.fingerprint, unit.done);
    for (std::size_t k = 0; k < unit.after.size(); ++k)
      fmt::format_to(line, "{}{}", k == 0 ? "" : ",", quote_for_json(plan.units[unit.after[k]].id()));
    lines += "]}\n";
  }
  return lines;
}

std::string plan_as_snakemake(const Plan& plan, const PlanCommand& command) {
  const std::vector<StageJobs> stages = stage_jobs(plan, command);
  const auto marks = [&](const auto& selected) {
    std::vector<std::string> all;
    for (const StageJobs& jobs : stages)
      if (selected(jobs)) all.push_back(all_marks(plan, jobs, command));
    return fmt::format("{}", fmt::join(all, ",\n           "));
  };
  const std::string all = marks([](const StageJobs&) { return true; });
  std::string text = "# One rule per stage; a stage over tiles or images is divided into shards.\n";
  text += command.map.empty()
              ? fmt::format("rule all:\n    input: {}\n", all)
              : fmt::format("rule map:\n    input: {}\n    output: {}\n{}    shell: {}\n", all,
                            python_string(command.map), snakemake_resources(resources_of(command, kMapCall)),
                            snakemake_shell(map_command(command)));
  for (const StageJobs& jobs : stages) {
    text += fmt::format("\nrule {}:\n", jobs.name);
    if (!jobs.after.empty())
      text +=
          fmt::format("    input: {}\n",
                      marks([&](const StageJobs& earlier) { return jobs.after.contains(earlier.stage); }));
    std::string call = snakemake_shell(job_command(jobs, command, "$shard"));
    if (const std::size_t at = call.find("$shard"); at != std::string::npos)
      call.replace(at, std::string_view("$shard").size(), "{wildcards.shard}");
    text += fmt::format("    output: touch({})\n{}    shell: {}\n",
                        python_string(shard_mark(plan, jobs, command)),
                        snakemake_resources(resources_of(command, jobs.name)), call);
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
  for (const StageJobs& jobs : stage_jobs(plan, command)) {
    std::string options;
    for (const std::size_t earlier : jobs.after)
      options += fmt::format("{}$stage_{}", options.empty() ? " --dependency=afterok:" : ":", earlier);
    if (!jobs.after.empty()) options += " --kill-on-invalid-dep=yes";
    if (jobs.shards > 0) options += fmt::format(" --array=1-{}", jobs.shards);
    options += sbatch_options(resources_of(command, jobs.name));
    submit(fmt::format("stage_{}", jobs.stage), jobs.name, options,
           job_command(jobs, command, "$SLURM_ARRAY_TASK_ID"));
    all += fmt::format(":$stage_{}", jobs.stage);
  }
  if (!command.map.empty())
    submit("map", "map",
           " --dependency=afterok" + all + " --kill-on-invalid-dep=yes" +
               sbatch_options(resources_of(command, kMapCall)),
           map_command(command));
  return script;
}

std::string plan_as_parallel(const Plan& plan, const PlanCommand& command) {
  std::string script =
      "#!/bin/sh\n# The shards of each stage run side by side, the stages in order.\nset -eu\n";
  for (const StageJobs& jobs : stage_jobs(plan, command))
    script += jobs.shards == 0 ? job_command(jobs, command, "") + "\n"
                               : fmt::format("seq {} | parallel --halt now,fail=1{} {}\n", jobs.shards,
                                             parallel_options(resources_of(command, jobs.name)),
                                             quote_for_shell(job_command(jobs, command, "{}")));
  if (!command.map.empty()) script += map_command(command) + "\n";
  return script;
}

}  // namespace waymark::pipeline
