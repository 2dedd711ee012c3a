// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
namespace waymark::pipeline {

/// Counts how many probable rocks are lit along the direction of the light: a check of the ground.
/// A rock is bright on the side of the sun. On leaves, buildings and coarse sand, dark spots have their
/// bright side anywhere.
struct LightCoherence {
  std::int64_t rocks = 0;  ///< spots more probable than 0.5 whose surroundings have a bright side
  std::int64_t along = 0;  ///< of these: bright side within 45 degrees of the axis of the light

  /// Returns the fraction along the axis; 0.5 by chance and where there are no rocks.
  double fraction() const;
  /// Returns an upper estimate of the fraction of these rocks that can be real, (0, 1]. It is 1 where their
  /// number is too small for a statement.
  double real_fraction() const;

  LightCoherence& operator+=(const LightCoherence& other);
};

}  // namespace waymark::pipeline
