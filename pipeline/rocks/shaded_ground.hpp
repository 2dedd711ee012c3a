// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
namespace waymark::pipeline {

/// Counts the pixels that are as dark as shadow. Rocks on shaded ground cast no shadow and are not found.
struct ShadedGround {
  std::int64_t pixels = 0;  ///< with data
  std::int64_t shaded = 0;  ///< of these: nearer to full shadow than a quarter of the depth of lit ground

  /// Returns the fraction in shadow; 0 where there are no pixels.
  double fraction() const;
  /// Returns true if the fraction is large enough to be stated: a tenth. A third of the rocks is missed
  /// there, but 1 in 20 where it is below 0.03 (docs/methods/rock_light.md).
  bool is_much() const;

  ShadedGround& operator+=(const ShadedGround& other);
};

}  // namespace waymark::pipeline
