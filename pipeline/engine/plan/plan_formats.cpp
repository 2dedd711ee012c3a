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
  return fmt::format("{} run {} --work {}", quote_for_shell(command.program), quote_for_shell(command.job),
                     quote_for_shell(command.work));
}

/// Returns a Python string literal.
std::string python_string(const std::string& text) {
  return nlohmann::json(text).dump();
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
  std::string text = fmt::format("rule all:\n    input: {}\n", manifests(all));
  for (const Unit& unit : plan.units) {
    text += fmt::format("\nrule {}_{}:\n", unit.stage, unit.item);
    if (!unit.after.empty()) text += fmt::format("    input: {}\n", manifests(unit.after));
    // Snakemake formats the shell command, so braces in a path are doubled.
    std::string shell = fmt::format("{} --unit {}", run_command(command), unit.id());
    for (const char brace : {'{', '}'})
      for (std::size_t at = 0; (at = shell.find(brace, at)) != std::string::npos; at += 2)
        shell.insert(at, 1, brace);
    text += fmt::format("    output: {}\n    shell: {}\n", manifest(unit, command), python_string(shell));
  }
  return text;
}

std::string plan_as_slurm(const Plan& plan, const PlanCommand& command) {
  constexpr std::size_t kMaxShards = 64;
  std::string script =
      "#!/bin/sh\n# One job per stage; a stage over tiles or images is an array of shards.\nset -eu\n";
  for (std::size_t stage = 0; stage < plan.stage_count(); ++stage) {
    const std::size_t begin = plan.begins[stage], end = plan.begins[stage + 1];
    if (begin == end) continue;
    std::set<std::size_t> after_stages;
    for (const std::size_t read : plan.units[begin].after)
      after_stages.insert(
          static_cast<std::size_t>(std::ranges::upper_bound(plan.begins, read) - plan.begins.begin()) - 1);
    std::string options;
    for (const std::size_t earlier : after_stages)
      options += fmt::format("{}$stage_{}", options.empty() ? " --dependency=afterok:" : ":", earlier);
    std::string work = fmt::format("{} --unit {}", run_command(command), plan.units[begin].id());
    if (plan.units[begin].index()) {
      const std::size_t shares = std::min(end - begin, kMaxShards);
      options += fmt::format(" --array=1-{}", shares);
      work = fmt::format("{} --shard $SLURM_ARRAY_TASK_ID/{}", run_command(command), shares);
    }
    script += fmt::format("stage_{}=$(sbatch --parsable --job-name={}{} --wrap {})\n", stage,
                          plan.units[begin].stage, options, quote_for_shell(work));
  }
  return script;
}

}  // namespace waymark::pipeline
