// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "geodb/shape_layer.hpp"
#include "pipeline/engine/runner.hpp"
#include "pipeline/forest/crown_table.hpp"
namespace waymark {

/// The layer `crown`: the crowns of all tables along a Hilbert curve through their tops, so that the layer
/// does not depend on the tables they came in. They are unpacked one by one, and few tables are in memory.
ShapeLayer crown_layer(std::vector<RunResult::Reader<CrownTable>> tables);

}  // namespace waymark
