// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include "landmarks/landmark_type.hpp"
namespace waymark::exporters {

/// Returns the form in which a view draws a type: "crown" for a canopy, else its solid.
std::string view_shape(const LandmarkType& type);

/// Returns the index of the feature that is the form's height, or the depth of a bowl; `std::nullopt` if the
/// type has none.
std::optional<std::size_t> height_of_shape(const LandmarkType& type);

}  // namespace waymark::exporters
