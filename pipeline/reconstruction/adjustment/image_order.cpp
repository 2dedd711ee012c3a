// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/image_order.hpp"

#include <string>

namespace waymark::pipeline {

ImageOrder::ImageOrder(const Reconstruction& scene)
    : images_(scene.images.size()), rank_(scene.images.size()) {
  std::iota(images_.begin(), images_.end(), std::size_t{0});
  std::ranges::stable_sort(images_, {},
                           [&](std::size_t i) -> const std::string& { return scene.images[i].name; });
  for (std::size_t r = 0; r < images_.size(); ++r) rank_[images_[r]] = r;
}

std::vector<RankedMark> ranked_marks(const std::vector<Mark>& marks, const Reconstruction& scene,
                                     const ImageOrder& order) {
  std::vector<RankedMark> out;
  for (std::size_t i = 0; i < marks.size(); ++i)
    if (scene.images[marks[i].image].world_from_camera)
      out.push_back({order.rank(marks[i].image), i, marks[i].pixel.x(), marks[i].pixel.y()});
  std::ranges::sort(out, {}, &RankedMark::key);
  return out;
}

}  // namespace waymark::pipeline
