// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>
#include "core/grid.hpp"
#include "exporters/report/relief_source.hpp"
#include "geo/body.hpp"
namespace waymark {

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0, alpha = 255;
  friend bool operator==(const Colour&, const Colour&) = default;
};

/// Colours of heights, from `lowest` to `highest` metres; lower and higher ones take the end colours.
/// On Earth, ground at or below 0 m is drawn as water, down to `lowest`.
struct HeightTint {
  double lowest = 0, highest = 1;
  bool water = false;
  std::vector<Colour> land;  ///< evenly spaced, at least two

  Colour operator()(double height) const;
};

/// Spans the heights of a picture without its most extreme percent, in colours that suit the body: greens to
/// snow on Earth, greys on the Moon, ochres on Mars, slate elsewhere.
HeightTint tint_for(const Relief& relief, const Body& body);

/// Shaded relief: tinted heights lit from the north-west, with the large forms lit once more for themselves
/// so that they are not lost in detail. Slopes are exaggerated until the steep ones look steep, at any scale.
/// Cells without a height are transparent.
Grid<Colour> shade(const Relief& relief, const HeightTint& tint);

/// The bytes of a PNG file, written by GDAL.
std::string png_of(const Grid<Colour>& picture);

}  // namespace waymark
