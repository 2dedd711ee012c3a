// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>
#include "pipeline/rocks/rock_evidence.hpp"
namespace waymark::pipeline {

inline constexpr std::size_t kRockOutputs = 8;     ///< see predict_rock
inline constexpr std::size_t kMaxRockUnits = 256;  ///< of the hidden layer

/// Network of predict_rock: standardised evidence, one hidden layer of hyperbolic tangents, eight outputs.
struct RockNetwork {
  float rock_prior = 0;         ///< fraction of rocks among the dark spots it was fitted to
  std::vector<float> mean, sd;  ///< of each evidence
  std::vector<float> hidden;    ///< weights of all units input by input, then their biases
  std::vector<float> out;       ///< weights of all outputs unit by unit, then their biases
  std::string trained_on;       ///< provenance, one line of text

  std::size_t units() const { return hidden.size() / (kEvidenceCount + 1); }
  friend bool operator==(const RockNetwork&, const RockNetwork&) = default;
};

/// Predicts with a network. The outputs are the log odds of a rock; log_radius, log_reach and along; and the
/// logarithms of the four standard deviations.
RockPrediction predict_rock(const RockNetwork& network, const RockEvidence& evidence);

/// Writes a network as text of kind `rocks`; numbers have four significant digits
/// (pipeline/vision/network_text.hpp).
std::string as_text(const RockNetwork& network);
/// Throws Error{input} that names `where`.
RockNetwork parse_rock_network(std::string_view text, const std::string& where);

/// Returns the shipped network, made by `waymark train rocks` (pipeline/rocks/built_in_rock_network.cpp).
const RockNetwork& built_in_rock_network();

}  // namespace waymark::pipeline
