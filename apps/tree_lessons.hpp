// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>
#include "apps/colour_image.hpp"
#include "pipeline/engine/progress_meter.hpp"
#include "pipeline/forest/crown_network.hpp"
#include "testbed/score.hpp"
namespace waymark {

/// An image whose trees are all marked.
struct TreeLesson {
  std::shared_ptr<const ColourImage> image;
  std::vector<MarkedTree> trees;  ///< in cells of the image
};

/// Reads an orthophoto in metres and, beside it, the table of its name that ends in .csv: x and y of every
/// tree in pixels. Throws Error{input}.
TreeLesson tree_lesson(const std::string& path, bool infrared);

/// `meter` counts the rounds of learning, here and below.
DenseNetwork crown_network_of(const std::vector<TreeLesson>& lessons, const NetworkTraining& training,
                              ProgressMeter& meter);

/// Finds of networks that have not seen the image they are asked about: lessons are dealt into `parts`, each
/// part is searched with a network trained on the others, for finds of confidence 0.5 and more. Places may be
/// 6 m off, as is usual for marked points.
Score held_out_score(const std::vector<TreeLesson>& lessons, int parts, const NetworkTraining& training,
                     int threads, ProgressMeter& meter);

}  // namespace waymark
