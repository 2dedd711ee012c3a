// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
namespace waymark::geodb {
class MapStore;
}

namespace waymark::exporters {

/// Returns the path of an image of a map: where the run read it, beside the map, or in `images` beside it.
/// `std::nullopt` if it is in none of these places.
std::optional<std::string> find_image_file(const geodb::MapStore& map, const std::string& name);

/// Returns figures of images with the observations in them: each image whole, and its densest part at full
/// resolution.
/// - Used observations have the colour of their type; rejected ones are dashed, with the reason as tooltip.
/// - Shows the `most` images with the most used observations.
/// - Files are searched at the paths of the run, and beside the map.
/// Empty if the map has no image with observations.
std::string image_figures(const geodb::MapStore& map, std::int64_t max_images);

}  // namespace waymark::exporters
