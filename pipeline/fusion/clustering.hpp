// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>
#include "pipeline/fusion/close_pairs.hpp"
#include "pipeline/fusion/sighting.hpp"
namespace waymark {

/// Which sightings show the same thing: per sighting the index of the first one of its thing.
/// Same type, never two of one source, likelihood first: the two things most likely to be one
/// (same_thing_cost) become one, their fused place and size take their stead, and so on until the rules leave
/// no pair. Comparing fused things and not their members keeps chains apart: A-B and B-C alike does not make
/// A-C one. Two things are only compared if some member of one was close to some member of the other. The
/// result depends on the order of the sightings only where costs tie: sort them by content first. Groups that
/// do not meet are solved in parallel. O(p log p) for p close pairs; 1e6 sightings of 2e5 things take about 3
/// s on one thread.
std::vector<std::uint32_t> cluster(std::span<const Sighting> sightings, const MapPlane& plane,
                                   const IdentityRules& rules);

/// The pairs that may be one thing by themselves: what `cluster` starts from.
std::vector<IndexPair> possible_pairs(std::span<const Sighting> sightings, const MapPlane& plane,
                                      const IdentityRules& rules);

}  // namespace waymark
