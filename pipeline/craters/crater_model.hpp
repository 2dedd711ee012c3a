// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>
#include "pipeline/craters/convolution_net.hpp"
#include "pipeline/craters/crater_features.hpp"
namespace waymark::pipeline {

/// Output of the model for one candidate.
struct CraterPrediction {
  double probability = 0;  ///< that it is a crater
  /// Offset of the rim centre in diameters of the candidate: along the light (towards the sun) and across
  /// it (from x towards y). `log_size`: natural logarithm of true over candidate diameter.
  double along = 0, across = 0, log_size = 0;
};

/// Classifier and regressor of crater candidates, trained on synthetic scenes. All networks have four
/// outputs (CraterPrediction).
/// - `layers`: dense network with two hidden layers (leaky rectifier, 0.1) on gradients and a thumbnail.
/// - `convolution_nets`: convolutional networks on a wider patch, averaged. They differ in initial weights
///   and order of examples; averaging reduces the variance of training. May be empty.
struct CraterModel {
  struct Layer {
    int inputs = 0, outputs = 0;
    std::vector<float> weights;  ///< output by output
    std::vector<float> biases;
  };
  std::vector<Layer> layers;
  std::vector<ConvolutionNet> convolution_nets;  ///< empty: the layers alone
  std::string trained_on;                        ///< one line for people
};

/// Applies dense layers to the features. O(weights), about 5 us.
CraterPrediction predict(std::span<const CraterModel::Layer> layers, const CraterFeatures& features);
/// Applies the dense network of a model.
CraterPrediction predict(const CraterModel& model, const CraterFeatures& features);
/// Returns the mean output of the convolutional networks, at least one. O(weights x positions), about 3 us
/// each.
CraterPrediction predict(std::span<const ConvolutionNet> convolution_nets, const WidePatch& wide);

/// Applies the predicted offset and size to the candidate.
CraterCandidate apply_correction(const CraterCandidate& candidate, const CraterPrediction& prediction,
                                 Radians sun_angle);

/// Writes a model as text of kind `craters` with packed numbers (pipeline/vision/network_text.hpp): dense
/// layers first; each convolutional network ends with four outputs at one position.
/// parse_crater_model throws Error{input} that names the malformed line.
std::string as_text(const CraterModel& model);
CraterModel parse_crater_model(std::string_view text, const std::string& where);

/// Returns the shipped model, made by `waymark train craters` (pipeline/craters/built_in_model.cpp).
const CraterModel& built_in_crater_model();

}  // namespace waymark::pipeline
