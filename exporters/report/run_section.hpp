// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "geodb/map_contents.hpp"
namespace waymark {

/// Per stage: in, out, rejected by reason, units, seconds, as an HTML table. Empty where the run left no
/// report.
std::string stage_table(const RunRecord& run);

/// What the stages warned of, and the units that failed, as an HTML list; empty where there is nothing to
/// say.
std::string warning_list(const RunRecord& run);

/// Version, command, job, seed, time and input files with their hashes.
std::string provenance(const std::vector<RunRecord>& runs);

}  // namespace waymark
