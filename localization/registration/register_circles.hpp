// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <optional>
#include <span>
#include <string>
#include "localization/registration/circle_evidence.hpp"
namespace waymark::localization {

/// Limits of a registration that is accepted.
struct CircleRules {
  double max_scale = 2;                                        ///< of a map, or its inverse; > 1
  double max_shift = std::numeric_limits<double>::infinity();  ///< of the map's middle, metres
  double max_wrong = 1e-3;                                     ///< probability of being wrong
  std::size_t min_matches = 4;
};

/// Result of a registration; `fit` is empty if it is refused.
struct CircleRegistration {
  std::optional<CircleFit> fit = {};
  double wrong = 1;          ///< probability that the best place is wrong
  std::string message = {};  ///< why it is refused, with numbers
};

/// Finds the similarity that places circles of a map in a catalogue, without a start. Pairs of the largest
/// circles, with the ratio of their diameters and their distance, suggest places; each is adjusted. The best
/// place is compared with all others, and with a map that is not in the catalogue, by their evidence
/// (Laplace's approximation, MacKay 1992).
CircleRegistration register_circles(std::span<const Circle> map, std::span<const Circle> catalogue,
                                    const CircleRules& rules = {});

}  // namespace waymark::localization
