// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/call_costs.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "core/atomic_file.hpp"
#include "core/json_text.hpp"
#include "core/text_file.hpp"

namespace waymark::workflows {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// Other units of a stage may be larger than those measured, and other machines slower.
constexpr double kMoreMemory = 1.5, kMoreTime = 3;
constexpr double kMegabytesInAll = 100;  // asked for in steps of it
constexpr const char* kMapCall = "map";

struct Cost {
  double seconds_per_unit = 0;
  double seconds_of_call = 0;  ///< start, plan, and what else does not grow with the units
  double megabytes = 0;
  int threads = 1;
};

/// Returns the folder of the costs of a stage, one file per part of the work.
fs::path folder_of(const fs::path& work, const std::string& stage) {
  return work / "costs" / stage;
}

// In place, which costs a call no rename and no flush: a file that a kill leaves incomplete is not read.
void keep(const pipeline::RunOptions& options, const std::string& stage, const Cost& cost) {
  if (options.work.empty()) return;
  const std::string part = options.shard ? fmt::format("{}_of_{}", options.shard->index, options.shard->count)
                           : options.unit.empty() ? "all"
                                                  : "unit";
  const fs::path folder = folder_of(options.work, stage);
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  const Json json{{"seconds_per_unit", cost.seconds_per_unit},
                  {"seconds_of_call", cost.seconds_of_call},
                  {"megabytes", cost.megabytes},
                  {"threads", cost.threads}};
  static_cast<void>(write_aside(folder / (part + ".json"), json.dump(2) + "\n"));
}

/// Returns a kept cost; `std::nullopt` if the file is damaged.
std::optional<Cost> read_cost(const fs::path& file) try {
  const Json json = Json::parse(checked_json(read_text(file, "a cost"), file.string()));
  const Cost cost{json.at("seconds_per_unit").get<double>(), json.at("seconds_of_call").get<double>(),
                  json.at("megabytes").get<double>(), json.at("threads").get<int>()};
  const auto is_amount = [](double value) { return value >= 0 && value < 1e9; };
  if (!is_amount(cost.seconds_per_unit) || !is_amount(cost.seconds_of_call) || !is_amount(cost.megabytes) ||
      cost.threads < 1)
    return std::nullopt;
  return cost;
} catch (const Error&) {
  return std::nullopt;
} catch (const Json::exception&) {
  return std::nullopt;
}

/// Returns the largest of each kind of cost of a stage; `std::nullopt` if none is kept.
std::optional<Cost> largest_cost(const fs::path& work, const std::string& stage) {
  std::optional<Cost> largest;
  std::error_code ignored;
  for (fs::directory_iterator at(folder_of(work, stage), ignored), end; !ignored && at != end;
       at.increment(ignored)) {
    const std::optional<Cost> cost = read_cost(at->path());
    if (!cost) continue;
    if (!largest) largest.emplace();
    largest->seconds_per_unit = std::max(largest->seconds_per_unit, cost->seconds_per_unit);
    largest->seconds_of_call = std::max(largest->seconds_of_call, cost->seconds_of_call);
    largest->megabytes = std::max(largest->megabytes, cost->megabytes);
    largest->threads = std::max(largest->threads, cost->threads);
  }
  return largest;
}

pipeline::CallResources resources_of(const Cost& cost, double units) {
  const double seconds = kMoreTime * (cost.seconds_of_call + cost.seconds_per_unit * units);
  return {.processors = cost.threads,
          .megabytes = static_cast<std::int64_t>(
              kMegabytesInAll * std::ceil(std::max(1.0, kMoreMemory * cost.megabytes) / kMegabytesInAll)),
          .minutes = static_cast<std::int64_t>(std::ceil(std::max(1.0, seconds) / 60))};
}

double megabytes_of_process() {
  ::rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  return static_cast<double>(used.ru_maxrss) * 1024 / 1e6;
}

Cost cost_of(const pipeline::RunOptions& options, const pipeline::RunReport& report,
             double seconds_per_unit) {
  double of_units = 0;
  for (const pipeline::StageReport& stage : report.stages)
    if (stage.made > 0) of_units += stage.seconds;
  const int all_processors = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return {.seconds_per_unit = seconds_per_unit,
          .seconds_of_call = std::max(0.0, report.seconds - of_units),
          .megabytes = megabytes_of_process(),
          .threads = options.threads > 0 ? options.threads : all_processors};
}

}  // namespace

void keep_costs(const pipeline::RunOptions& options, const pipeline::RunReport& report) {
  for (const pipeline::StageReport& stage : report.stages)
    if (stage.made > 0)
      keep(options, stage.stage, cost_of(options, report, stage.seconds / static_cast<double>(stage.made)));
}

void keep_cost_of_map(const pipeline::RunOptions& options, const pipeline::RunReport& report,
                      double seconds) {
  keep(options, kMapCall, cost_of(options, report, seconds));
}

MeasuredResources measured_resources(const fs::path& work, const pipeline::Plan& plan,
                                     std::size_t max_shards) {
  MeasuredResources all;
  const auto add = [&](const std::string& stage, double units, bool is_done) {
    if (const std::optional<Cost> cost = largest_cost(work, stage))
      all.by_stage[stage] = resources_of(*cost, units);
    else if (!is_done)
      all.unknown.push_back(stage);
  };
  for (std::size_t stage = 0; stage < plan.stage_count(); ++stage) {
    const std::size_t units = plan.begins[stage + 1] - plan.begins[stage];
    if (units == 0) continue;
    const pipeline::Unit& first = plan.units[plan.begins[stage]];
    const std::size_t calls = first.index() ? std::min(units, max_shards) : 1;
    const bool is_done = std::all_of(plan.units.begin() + static_cast<std::ptrdiff_t>(plan.begins[stage]),
                                     plan.units.begin() + static_cast<std::ptrdiff_t>(plan.begins[stage + 1]),
                                     [](const pipeline::Unit& unit) { return unit.done; });
    add(first.stage, std::ceil(static_cast<double>(units) / static_cast<double>(calls)), is_done);
  }
  add(kMapCall, 1, false);
  return all;
}

}  // namespace waymark::workflows
