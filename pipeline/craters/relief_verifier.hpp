// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>
#include "pipeline/craters/crater_model.hpp"
namespace waymark::pipeline {

/// Second opinion on craters that a CraterModel found: dense networks on CraterFeatures, trained on images of
/// measured relief (relief_training.hpp). They know degraded, filled and overlapping craters as they are;
/// the model knows what drawn scenes vary.
struct ReliefVerifier {
  using Network = std::vector<CraterModel::Layer>;  ///< the last layer has the outputs of CraterPrediction
  std::vector<Network> networks;                    ///< averaged; they differ in initial weights and order
  double prior = 0.5;                               ///< fraction of craters among the training examples
  std::string trained_on;                           ///< one line for people
};

/// Returns the mean log odds of the networks, for a prior of one half.
double log_odds(const ReliefVerifier& verifier, const CraterFeatures& features);

/// Writes a verifier as text of kind `craters_in_relief` with packed numbers, network after network.
/// parse_relief_verifier throws Error{input} that names the malformed line.
std::string as_text(const ReliefVerifier& verifier);
ReliefVerifier parse_relief_verifier(std::string_view text, const std::string& where);

/// Returns the shipped verifier, made by `waymark train craters --relief`
/// (pipeline/craters/built_in_relief_verifier.cpp).
const ReliefVerifier& built_in_relief_verifier();

}  // namespace waymark::pipeline
