// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// Options of a training. The same scenes, images and seed give the same model.
struct TrainRequest {
  std::string what;                      ///< "craters" or "trees"
  std::string output = {};               ///< model to write, .txt, or .cpp for a source file; empty: none
  std::int64_t scenes = 120;             ///< craters: made scenes; each takes about two seconds
  std::vector<std::string> images = {};  ///< trees: orthophotos, each with a table of its trees beside it
  bool colour = false;                   ///< trees: train on red, green and blue alone
  std::int64_t rounds = 0;               ///< passes over all examples; 0: the default of the model
  std::int64_t seed = 1;
  int threads = 0;  ///< 0: one per processor
};

/// A trained model.
struct TrainResult {
  std::string model;  ///< text that parse_crater_model() or parse_dense_network() reads
};

/// Trains a model of craters or of trees in colour images and writes it. Throws Error{usage} for missing or
/// superfluous images, Error{input} for an image that cannot be used, Error{output}.
/// Messages: summaries of the rounds, and for trees the cross-validated score.
TrainResult train(const TrainRequest& request, const Callbacks& callbacks = {});

}  // namespace waymark::workflows
