// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "core/observation.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::pipeline {

/// Ellipse of a rim: full axes, metres; orientation of the major axis, radians clockwise from north.
struct RimAxes {
  double major = 0, minor = 0, orientation = 0;
};

/// Returns the rim of an observed bowl from its features `major_axis`, `minor_axis` and `orientation`;
/// unknown axes are those of a circle of the body's size. `std::nullopt` if the size is unknown.
std::optional<RimAxes> rim_axes(const Observation& bowl, const LandmarkType& type);

}  // namespace waymark::pipeline
