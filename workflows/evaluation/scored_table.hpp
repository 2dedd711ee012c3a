// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>
#include "landmarks/sensor_profile.hpp"
#include "testbed/score.hpp"
namespace waymark::workflows {

/// Objects by landmark type; "" for a table without types.
using ScoredTables = std::map<std::string, std::vector<testbed::EvaluatedObject>>;

/// Reads a map (*.gpkg made by Waymark: all types, covariances, quality), a CSV or any layer of points.
/// Throws Error{input} naming the file for a table without positions or a cell that is no number.
/// - Columns are found by name, see `waymark evaluate --help`; a table without a header has x, y, diameter.
/// - `type` empty: all. `sensor` weighs the quality of a map; null: equal weights.
/// - Rows with `images` 0 or `pixels` below `min_pixels` are marked as ignored.
ScoredTables read_scored_things(const std::string& path, const std::string& type, double min_pixels,
                                const SensorProfile* sensor = nullptr);

/// Pairs found and true objects by type. Objects without a type are compared with the other side's only type,
/// or with `type`. Throws Error{usage} if that is ambiguous.
std::map<std::string, std::pair<std::vector<testbed::EvaluatedObject>, std::vector<testbed::EvaluatedObject>>>
pair_by_type(const ScoredTables& found, const ScoredTables& truth, const std::string& type);

}  // namespace waymark::workflows
