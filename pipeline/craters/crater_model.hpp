// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>
#include "pipeline/craters/convolution_net.hpp"
#include "pipeline/craters/crater_features.hpp"
namespace waymark {

/// What the model says of a candidate.
struct CraterVerdict {
  double probability = 0;  ///< that it is a crater
  /// Where its rim is, in the candidate's diameters, the first along the light (towards the sun), the second
  /// a quarter turn on (from x towards y); and the natural logarithm of the true diameter over the
  /// candidate's.
  double along = 0, across = 0, log_size = 0;
};

/// Networks of four outputs each, small on purpose, trained on made-up scenes: one of two hidden layers
/// (rectified, leak 0.1) on gradients and a thumbnail, and convolutional ones on brightness over a wider
/// patch, which may be missing. They err on different candidates; the convolutional ones, alike but for their
/// first weights and the order of the lessons, are averaged, which takes the chance of training out.
struct CraterModel {
  struct Layer {
    int inputs = 0, outputs = 0;
    std::vector<float> weights;  ///< output by output
    std::vector<float> biases;
  };
  std::vector<Layer> layers;
  std::vector<ConvolutionNet> looks;  ///< empty: the layers alone
  std::string trained_on;             ///< one line for people
};

/// O(weights), about 5 us.
CraterVerdict judge(const CraterModel& model, const CraterFeatures& features);
/// The mean answer. O(weights x places), about 3 us each. There is one at least.
CraterVerdict judge(std::span<const ConvolutionNet> looks, const CraterLook& look);

/// The circle the verdict speaks of.
CraterCandidate corrected(const CraterCandidate& candidate, const CraterVerdict& verdict, Radians sun_angle);

/// Text: a line `waymark crater model 1`, a line of provenance, then per layer its sizes and per output a
/// line: bias, largest weight, and the weights as sixteen-bit shares of it in three base-64 digits each. A
/// convolution's line is `convolution SIDE CHANNELS FACTS KERNEL STRIDE OUTPUTS`; they follow the layers,
/// network by network: each ends with four outputs at one place.
/// parse throws Error{input} naming the line that does not fit.
std::string as_text(const CraterModel& model);
CraterModel parse_crater_model(std::string_view text, const std::string& where);

/// The model that `waymark train craters` made and we ship (pipeline/craters/built_in_model.cpp).
const CraterModel& built_in_crater_model();

}  // namespace waymark
