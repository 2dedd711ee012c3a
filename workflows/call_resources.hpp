// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <span>
#include <string>
#include "pipeline/engine/runner.hpp"
namespace waymark::workflows {

/// Reads "cpus=2,memory=8G,time=90" for all calls of a plan, or "STAGE:cpus=..." for one stage or `map`.
/// - memory ends in M or G (1e6, 1e9 bytes); time is in minutes, or ends in h.
/// - What a stage does not name is that of all calls, and what these do not name that of `measured`.
/// Throws Error{usage} for other words, for a name that is not in `stages`, and for a name given twice.
std::map<std::string, pipeline::CallResources> parse_resources(
    std::span<const std::string> texts, std::span<const std::string> stages,
    std::map<std::string, pipeline::CallResources> measured = {});

}  // namespace waymark::workflows
