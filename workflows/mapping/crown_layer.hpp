// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "geodb/shape_layer.hpp"
#include "pipeline/engine/runner.hpp"
#include "pipeline/forest/crown_table.hpp"
namespace waymark::workflows {

/// Returns the layer `crown`: the crowns of all tables, ordered along a Hilbert curve through their tops. The
/// order does not depend on the tables. Crowns are unpacked one by one, and few tables are in memory.
geodb::ShapeLayer crown_layer(std::vector<pipeline::RunResult::Reader<pipeline::CrownTable>> tables);

}  // namespace waymark::workflows
