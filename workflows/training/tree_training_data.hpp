// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>
#include "pipeline/engine/progress_meter.hpp"
#include "pipeline/forest/crown_network.hpp"
#include "testbed/score.hpp"
#include "workflows/detection/colour_image.hpp"
namespace waymark::workflows {

/// Image whose trees are all marked.
struct TreeTrainingImage {
  std::shared_ptr<const ColourImage> image;
  std::vector<pipeline::MarkedTree> trees;  ///< in cells of the image
};

/// Reads an orthophoto in metres and the .csv of the same name beside it: x and y of every tree in pixels.
/// Throws Error{input}.
TreeTrainingImage read_training_image(const std::string& path, bool infrared);

/// Trains a network on all images. `meter` counts the rounds, here and below.
pipeline::DenseNetwork train_crown_network(const std::vector<TreeTrainingImage>& images,
                                           const pipeline::NetworkTraining& training,
                                           pipeline::ProgressMeter& meter);

/// Cross-validates: divides the images into `parts` and searches each part with a network trained on the
/// others. Scores detections of confidence 0.5 and more; positions may be 6 m off, as is usual for marked
/// points.
testbed::Score cross_validate(const std::vector<TreeTrainingImage>& images, int parts,
                              const pipeline::NetworkTraining& training, int threads,
                              pipeline::ProgressMeter& meter);

}  // namespace waymark::workflows
