// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "workflows/training/rock_relief.hpp"
namespace waymark::workflows {

/// Shadows that a relief casts on itself, sample by sample along the ray to the sun. Steps over squares of
/// samples that lie below the ray.
class ReliefShadows {
 public:
  /// `elevation` and `angle` of the sun, rad; the angle from columns towards rows. The relief must outlive
  /// this.
  ReliefShadows(const RockRelief& relief, double elevation, double angle);
  bool is_shadowed(std::int64_t column, std::int64_t row) const;

 private:
  /// Highest samples of squares: a ray above a square is above the rest of it, too.
  struct Squares {
    int bits;  ///< log2 of the side, samples
    std::int64_t columns;
    std::vector<float> top;
  };
  const RockRelief& relief_;
  double step_x_, step_y_, rise_;  ///< per sample along the ray
  std::vector<Squares> squares_;   ///< of sides 16, 64 and 256
  double highest_;
};

}  // namespace waymark::workflows
