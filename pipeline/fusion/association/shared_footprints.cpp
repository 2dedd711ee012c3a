// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/association/shared_footprints.hpp"

#include <Eigen/Geometry>

namespace waymark::pipeline {

std::vector<double> shared_footprints(std::span<const ImageView> images) {
  std::vector<Eigen::AlignedBox2d> boxes(images.size());
  for (std::size_t i = 0; i < images.size(); ++i)
    for (const auto& ring : images[i].footprint)
      for (const auto& corner : ring) boxes[i].extend(corner);
  std::vector<double> shared(images.size(), 1);
  for (std::size_t i = 0; i < images.size(); ++i)
    for (std::size_t j = 0; j < images.size(); ++j)
      if (i != j && images[j].dem_constraint && boxes[i].intersects(boxes[j]) && boxes[i].volume() > 0)
        shared[i] += boxes[i].intersection(boxes[j]).volume() / boxes[i].volume();
  return shared;
}

}  // namespace waymark::pipeline
