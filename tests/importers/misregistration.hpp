// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "geo/image_source.hpp"
#include "geo/terrain.hpp"
namespace waymark::test {

/// An image in memory with its camera.
struct Photo {
  Pixels pixels;
  PosedCamera view;
};

Photo photo(const ImageSource& image);

/// Measures the shift between two photos projected onto the terrain: metres, east and north, at positions on
/// a regular grid where both show texture. Patches are compared by normalised correlation.
std::vector<Eigen::Vector2d> shifts(const Photo& a, const Photo& b, const Terrain& terrain,
                                    double metres_per_pixel, int places_across = 24);

/// Returns the median length of the shifts, metres.
double median_length(const std::vector<Eigen::Vector2d>& shifts);

/// Returns the length of the median shift, metres.
double common_shift(const std::vector<Eigen::Vector2d>& shifts);

}  // namespace waymark::test
