// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "geodb/map_contents.hpp"
namespace waymark::exporters {

/// Returns a table of the stages as HTML: in, out, rejected by reason, units, seconds. Empty if the run has
/// no report.
std::string stage_table(const geodb::RunRecord& run);

/// Returns the warnings of the stages and the failed units as an HTML list; empty if there are none.
std::string warning_list(const geodb::RunRecord& run);

/// Returns version, command, job, seed, time and input files with their hashes.
std::string provenance(const std::vector<geodb::RunRecord>& runs);

}  // namespace waymark::exporters
