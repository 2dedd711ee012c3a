// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>
#include "core/grid.hpp"
#include "exporters/report/relief_source.hpp"
#include "geo/body.hpp"
namespace waymark::exporters {

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0, alpha = 255;
  friend bool operator==(const Colour&, const Colour&) = default;
};

/// Hypsometric tints from `lowest` to `highest` metres; heights beyond take the end colours. On Earth,
/// heights at or below 0 m are drawn as water, down to `lowest`.
struct HypsometricTint {
  double lowest = 0, highest = 1;
  bool water = false;
  std::vector<Colour> land;  ///< evenly spaced, at least two

  Colour operator()(double height) const;
};

/// Returns tints for the heights of a picture without its most extreme percent, in colours of the body:
/// greens to snow on Earth, greys on the Moon, ochres on Mars, slate elsewhere.
HypsometricTint hypsometric_tint(const Relief& relief, const Body& body);

/// Computes shaded relief: tinted heights lit from the north-west, with large forms lit separately so that
/// detail does not hide them. Slopes are exaggerated until the steep ones look steep, at any scale. Cells
/// without a height are transparent.
Grid<Colour> shade(const Relief& relief, const HypsometricTint& tint);

/// Returns the bytes of a PNG file, written by GDAL.
std::string encode_png(const Grid<Colour>& picture);
/// Returns the same without alpha, compressed faster: for pictures whose colours are numbers.
std::string encode_rgb_png(const Grid<Colour>& picture);
/// Returns the bytes of a JPEG file, one band if every pixel is grey. `quality` is 1 to 100; alpha is
/// ignored.
std::string encode_jpeg(const Grid<Colour>& picture, int quality);

}  // namespace waymark::exporters
