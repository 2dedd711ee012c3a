// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "core/landmark.hpp"
#include "pipeline/forest/crown_table.hpp"
namespace waymark {

/// The crowns of trees, in the order of the trees and named after them. Of a tree with several the one drawn
/// on the canopy model whose name comes first; `evidence` in the order of comes_before
/// (pipeline/fusion/merging.hpp). Trees whose crown was not drawn have none.
CrownTable name_crowns(std::span<const CrownTable> drawn, std::span<const Observation> evidence,
                       std::span<const Landmark> trees);

}  // namespace waymark
