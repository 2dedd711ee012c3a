// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "geo/image_source.hpp"
#include "geo/terrain.hpp"
namespace waymark::testing {

/// An image in memory with its camera.
struct Photo {
  Pixels pixels;
  PosedCamera view;
};

Photo photo(const ImageSource& image);

/// How far the same ground lies apart in two photos that are laid on the terrain: shifts in metres, east and
/// north, at places on a regular grid where both see textured ground. Patches are compared by normalised
/// correlation.
std::vector<Eigen::Vector2d> shifts(const Photo& a, const Photo& b, const Terrain& terrain,
                                    double metres_per_pixel, int places_across = 24);

/// The median length of the shifts, metres.
double median_length(const std::vector<Eigen::Vector2d>& shifts);

/// The length of the median shift: what the two are apart as a whole.
double common_shift(const std::vector<Eigen::Vector2d>& shifts);

}  // namespace waymark::testing
