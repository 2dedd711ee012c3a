// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include "pipeline/engine/pipeline.hpp"
namespace waymark {

/// A pipeline as a file:
///   {"name": "alps", "stages": [{"stage": "load_dem", "files": ["a.tif"]}, {"stage": "find_mountain_tops"}]}
struct Job {
  std::string name;
  Pipeline pipeline;
};

/// Reads a job file; relative paths in it start at its folder. Throws Error{usage}: for text that is not JSON
/// with file, line and column; for all else with the place in the JSON and the nearest name.
Job read_job(const std::filesystem::path& file, const Registry& registry);

/// The same from text; `origin` is what messages call it.
Job parse_job(std::string_view json, const Registry& registry, std::string_view origin = "job");

/// The job as a file that would give the same run, every option filled in; indented JSON.
std::string job_as_json(std::string_view name, const Pipeline& pipeline);

}  // namespace waymark
