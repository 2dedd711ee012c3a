// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "pipeline/engine/step.hpp"
namespace waymark {

// A stage described from its one declaration; `step` is Registry::at(name), its options are the defaults.

/// Plain text for a terminal: summary, ports, options with units, ranges and defaults.
std::string stage_as_text(const Step& step);
/// The reference page docs/stages/<name>.md.
std::string stage_as_markdown(const Step& step);
/// JSON schema (2020-12) of the stage's object in a job file; units as "x-unit".
std::string stage_as_schema(const Step& step);
/// Name, summary, version, scope, ports and options as one JSON object.
std::string stage_as_json(const Step& step);

}  // namespace waymark
