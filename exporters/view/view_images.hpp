// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "exporters/view/view_frame.hpp"
#include "exporters/view/view_scene.hpp"
#include "geo/camera.hpp"
namespace waymark::geodb {
class MapStore;
}

namespace waymark::exporters {

/// An image with its pose in the grid of the map.
struct PosedImageFile {
  std::string name;
  std::string path;  ///< empty: the file is missing
  PosedCamera view;
};

/// Returns the images of a map that have a frame camera and a pose, in the map's order. A damaged record is
/// left out.
std::vector<PosedImageFile> posed_images(const geodb::MapStore& map);

/// Makes the images of a page: at most `max_images`, evenly spread, with pictures of `pixels`.
std::vector<ViewImage> make_view_images(const std::vector<PosedImageFile>& images, const ViewFrame& frame,
                                        std::size_t max_images = 24, std::int64_t pixels = 640);

}  // namespace waymark::exporters
