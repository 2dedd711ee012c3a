// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include "exporters/view/view_frame.hpp"
#include "exporters/view/view_scene.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::exporters {

/// Returns the shape in which the viewer draws a type, from what the type declares:
/// - With a direction (Scale::direction, the normal of a face): `panel` if it has a `length`, `corner` an
///   `opening_angle`, `end` a `side`, `plate` a `height`.
/// - With an axis (Scale::axis, the long side): `block` if it is upright with a body, `strip` if it has
/// `length`
///   and `width`, `portal` a `width` alone.
/// - All others: the solid of solid_name().
std::string view_shape(const LandmarkType& type);

/// Returns whether a shape turns with its direction or axis, so that landmarks have a ViewForm.
bool is_oriented(std::string_view shape);

/// Returns direction and sizes of a landmark of an oriented shape.
ViewForm view_form(const Landmark& landmark, const LandmarkType& type, const ViewFrame& frame);

}  // namespace waymark::exporters
