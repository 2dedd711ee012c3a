// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "geodb/rtree/packed_rtree.hpp"
namespace waymark::geodb {

/// Sorts boxes by the positions of their centres on a Hilbert curve over their common extent. Near boxes then
/// share a node of the spatial index.
void sort_along_curve(std::vector<IndexedBox>& boxes);

}  // namespace waymark::geodb
