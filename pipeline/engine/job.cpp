// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "core/error.hpp"
#include "core/json_text.hpp"
#include "core/text_file.hpp"
#include "pipeline/engine/step_options.hpp"

namespace waymark::pipeline {
namespace {

using Json = nlohmann::ordered_json;

[[noreturn]] void refuse(std::string problem, std::string_view origin, std::string hint = {}) {
  throw Error(ErrorCode::usage, std::move(problem), std::string(origin), std::move(hint));
}

/// Detects duplicate keys; the JSON parser would silently keep the last.
class DuplicateKeys {
 public:
  bool operator()(int, Json::parse_event_t event, const Json& parsed) {
    using Event = Json::parse_event_t;
    if (event == Event::object_start) open_.emplace_back();
    if (event == Event::object_end) open_.pop_back();
    if (event == Event::key && !open_.back().insert(parsed.get<std::string>()).second && first_.empty())
      first_ = parsed.get<std::string>();
    return true;
  }
  const std::string& first() const { return first_; }

 private:
  std::vector<std::set<std::string>> open_;
  std::string first_;
};

Json parse_json(std::string_view text, std::string_view origin) {
  DuplicateKeys duplicates;
  Json json = Json::parse(checked_json(text, origin, ErrorCode::usage), std::ref(duplicates));
  if (!duplicates.first().empty())
    refuse(fmt::format("the key '{}' is given twice", duplicates.first()), origin);
  return json;
}

void expect(bool fits, const std::string& location, const char* kind, const Json& found,
            std::string_view origin) {
  if (!fits) refuse(fmt::format("{} must be {}, is {}", location, kind, found.type_name()), origin);
}

void add_stage(Pipeline& pipeline, const Json& entry, std::size_t index, std::string_view origin) {
  const std::string location = fmt::format("stages[{}]", index);
  expect(entry.is_object(), location, "an object", entry, origin);
  if (!entry.contains("stage")) refuse(location + " has no \"stage\"", origin, "add the name of a stage");
  expect(entry["stage"].is_string(), location + ".stage", "a string", entry["stage"], origin);
  Json options = entry;
  options.erase("stage");
  pipeline.add(entry["stage"].get<std::string>(), options.dump());
}

}  // namespace

Job parse_job(std::string_view text, const Registry& registry, std::string_view origin) {
  const Json json = parse_json(text, origin);
  expect(json.is_object(), "the job", "an object", json, origin);
  for (const auto& [key, value] : json.items()) {
    const std::vector<std::string> keys{"name", "stages"};
    if (std::ranges::find(keys, key) != keys.end()) continue;
    const std::string near = nearest_name(key, keys);
    refuse(fmt::format("the job has no '{}'{}", key,
                       near.empty() ? "" : fmt::format("; did you mean '{}'?", near)),
           origin, "a job has a name and stages");
  }
  Job job{.name = {}, .pipeline = Pipeline(registry)};
  if (json.contains("name")) {
    expect(json["name"].is_string(), "name", "a string", json["name"], origin);
    job.name = json["name"].get<std::string>();
  }
  if (!json.contains("stages")) refuse("the job has no \"stages\"", origin, "a job has a name and stages");
  expect(json["stages"].is_array(), "stages", "an array", json["stages"], origin);
  try {
    for (std::size_t i = 0; i < json["stages"].size(); ++i)
      add_stage(job.pipeline, json["stages"][i], i, origin);
    job.pipeline.check();
  } catch (const Error& error) {
    throw Error(error.code(), error.problem(), std::string(origin), error.hint());
  }
  return job;
}

Job read_job(const std::filesystem::path& file, const Registry& registry) {
  Job job = parse_job(read_text(file, "the job file", ErrorCode::usage), registry, file.string());
  job.pipeline.base_folder = file.parent_path();
  return job;
}

std::string job_as_json(std::string_view name, const Pipeline& pipeline) {
  Json stages = Json::array();
  for (const auto& step : pipeline.steps()) {
    Json stage{{"stage", step->spec().name}};
    stage.update(Json::parse(options_as_json(option_table(*step))));
    stages.push_back(std::move(stage));
  }
  return Json{{"name", name}, {"stages", std::move(stages)}}.dump(2, ' ', false,
                                                                  Json::error_handler_t::replace);
}

}  // namespace waymark::pipeline
