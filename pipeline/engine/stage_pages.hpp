// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "pipeline/engine/step.hpp"
namespace waymark::pipeline {

// Descriptions of a stage generated from its declaration. `step` is Registry::at(name) with default options.

/// Returns text for a terminal: summary, ports, options with units, ranges and defaults.
std::string stage_as_text(const Step& step);
/// Returns the reference page docs/stages/NAME.md.
std::string stage_as_markdown(const Step& step);
/// Returns the JSON schema (2020-12) of the stage's object in a job file, with units as "x-unit".
std::string stage_as_schema(const Step& step);
/// Returns name, summary, version, scope, ports and options as one JSON object.
std::string stage_as_json(const Step& step);

}  // namespace waymark::pipeline
