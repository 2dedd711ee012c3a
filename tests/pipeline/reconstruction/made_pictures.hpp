// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include "geo/camera.hpp"
#include "geo/image_source.hpp"
namespace waymark::test {

/// Ground with texture at all scales; heights are `relief` times smooth noise, or those of terraces.
struct MadeGround {
  double relief = 0;      ///< metres, standard deviation
  double longest = 40;    ///< metres, longest wavelength of the texture
  double shortest = 0.1;  ///< metres
  std::uint32_t seed = 1;

  double height(double x, double y) const;
  double brightness(double x, double y) const;  ///< [0, 255]
};

/// Returns the picture of the ground; NaN above the horizon.
Pixels made_picture(const MadeGround& ground, const PosedCamera& view);

/// Returns a camera of a field of view across its columns, degrees.
Camera made_camera(std::int64_t columns, std::int64_t rows, double field_of_view);

/// Returns a view from a position, tilted by degrees towards a heading (clockwise from north).
PosedCamera made_view(const Camera& camera, const Eigen::Vector3d& position, double tilt, double heading,
                      double turn = 0);

}  // namespace waymark::test
