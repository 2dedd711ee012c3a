// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include "pipeline/engine/pipeline.hpp"
namespace waymark::pipeline {

/// A pipeline as a file:
///   {"name": "alps", "stages": [{"stage": "load_dem", "files": ["a.tif"]}, {"stage": "find_mountain_tops"}]}
struct Job {
  std::string name;
  Pipeline pipeline;
};

/// Reads a job file. Relative paths in it start at its folder.
/// Throws Error{usage}: with file, line and column if the text is not JSON, else with the JSON location and
/// the nearest valid name.
Job read_job(const std::filesystem::path& file, const Registry& registry);

/// Parses a job from text. `origin` is its name in messages.
Job parse_job(std::string_view json, const Registry& registry, std::string_view origin = "job");

/// Returns the job as indented JSON with every option filled in; running it repeats the run.
std::string job_as_json(std::string_view name, const Pipeline& pipeline);

}  // namespace waymark::pipeline
