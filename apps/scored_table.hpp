// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>
#include "testbed/score.hpp"
namespace waymark {

/// Things by landmark type; the type of a table that does not tell is "".
using ScoredTables = std::map<std::string, std::vector<ScoredThing>>;

/// Reads a map (*.gpkg made by Waymark: all types, covariances, quality), a CSV or any layer of points.
/// Columns by name, see `waymark evaluate --help`; a table without a header has x, y, diameter. `type` empty:
/// all. Rows whose `images` is 0 or `pixels` below `min_pixels` are ignored things. Throws Error{input}
/// naming the file: no positions, a cell that is no number.
ScoredTables scored_things(const std::string& path, const std::string& type, double min_pixels);

/// Found and true things of one type each. Where one side does not tell types, its things are compared with
/// the other side's only type, or with `type`; throws Error{usage} where that is not clear.
std::map<std::string, std::pair<std::vector<ScoredThing>, std::vector<ScoredThing>>> paired_types(
    const ScoredTables& found, const ScoredTables& truth, const std::string& type);

}  // namespace waymark
