// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
namespace waymark::pipeline {

/// Tallest tree that can be, metres. The tallest known, Hyperion, has 116 m.
inline constexpr double kTallestTree = 120;

/// Counts trees that could stand: a check that a band holds heights above ground. Brightness and elevations
/// above sea level have tops, too, but few of them have the shape of a tree.
struct TreeShapes {
  std::int64_t trees = 0;
  std::int64_t possible = 0;  ///< at most kTallestTree tall, with a crown of a tenth of the height or more

  /// Counts a tree, metres.
  void add(double height, double crown_diameter);
  /// Returns an upper estimate of the fraction of the trees that can be real, [0.02, 1].
  double real_fraction() const;
};

/// Returns the warning about a band that holds no heights above ground.
std::string tree_shapes_warning(const TreeShapes& seen);

/// Counts crowns by colour: a check that an image shows vegetation. Rocks, roofs and shadows are as dark as
/// crowns, but not green.
struct CrownColours {
  std::int64_t green = 0;  ///< coloured as vegetation
  std::int64_t other = 0;

  /// Returns the fraction of the `other` crowns that can be real, [0, 1]: nine of ten trees are green, give
  /// or take two standard deviations.
  double real_fraction_of_other() const;
};

/// Returns whether the mean colour of a crown is that of vegetation. `index` is the normalised difference of
/// infrared and red, or the excess green (2 g - r - b) / (r + g + b) of images without infrared.
bool is_vegetation(double index, bool infrared);

/// Returns the warning about an image whose crowns are not green.
std::string crown_colours_warning(const CrownColours& seen);

}  // namespace waymark::pipeline
