// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// Options of a training. The same scenes, images and seed give the same model.
struct TrainRequest {
  std::string what;         ///< "craters", "rocks" or "trees"
  std::string output = {};  ///< model to write, .txt, or .cpp for a source file; empty: none
  /// Made scenes; 0: 120 of craters (300 of relief), 240 of rocks, 120 forests of each type. With labels
  /// views of each image; 0: 12.
  std::int64_t scenes = 0;
  /// craters: "DEM,CATALOGUE" of measured relief with all its craters; trains the verifier, not the model.
  std::vector<std::string> relief = {};
  /// craters: "IMAGE,TABLE" of images whose craters are all marked; trains the verifier on them instead.
  std::vector<std::string> labels = {};
  std::vector<std::string> images = {};  ///< trees: orthophotos, each with a table of its trees beside it
  bool colour = false;                   ///< trees: train on red, green and blue alone
  std::int64_t rounds = 0;               ///< passes over all examples; 0: the default of the model
  std::int64_t seed = 1;
  int threads = 0;  ///< 0: one per processor
};

/// A trained model.
struct TrainResult {
  std::string model;       ///< text (pipeline/vision/network_text.hpp)
  std::string trained_on;  ///< scenes or images, examples, rounds, seed; one line
};

/// Trains a model and writes it:
/// - craters: the classifier of bowls, on scenes of the testbed and of plain shading; with relief
///   the verifier of what it finds, on images of that relief; with labels likewise, on the marked images;
/// - rocks: the network of shadows, on images of synthetic rocks;
/// - trees without images: the confidence of treetops in canopy models, on synthetic forests;
/// - trees with images: the network of crowns in colour images.
/// Throws Error{usage} for superfluous images or options, Error{input} for an image that cannot be used,
/// Error{output}. Messages: summaries of the training, and for crowns the cross-validated score.
TrainResult train(const TrainRequest& request, const Callbacks& callbacks = {});

}  // namespace waymark::workflows
