// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "core/landmark.hpp"
#include "pipeline/forest/crown_table.hpp"
namespace waymark::pipeline {

/// Returns the crowns of `trees`, in their order, with the uids of the trees. Of several crowns of a tree
/// the one on the canopy model whose name comes first is taken. `evidence` is sorted by comes_before
/// (pipeline/fusion/association/merging.hpp). Trees without an outline have none.
CrownTable name_crowns(std::span<const CrownTable> drawn, std::span<const Observation> evidence,
                       std::span<const Landmark> trees);

}  // namespace waymark::pipeline
