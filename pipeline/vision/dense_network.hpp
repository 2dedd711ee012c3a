// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>
namespace waymark::pipeline {

/// Small network of dense layers with rectifiers between them and one output: the log odds of the trained
/// class. Inputs are standardised: (value - centre) / scale.
struct DenseNetwork {
  struct Layer {
    int inputs = 0, outputs = 0;
    std::vector<float> weights;  ///< output by output
    std::vector<float> biases;
    friend bool operator==(const Layer&, const Layer&) = default;
  };
  std::vector<float> centre, scale;  ///< per input
  std::vector<Layer> layers;         ///< the last has one output
  std::string trained_on;            ///< provenance, one line of text

  friend bool operator==(const DenseNetwork&, const DenseNetwork&) = default;
};

/// Computes the log odds of `log_odds.size()` examples; inputs[i] points at their values of input i. Sums
/// run in the order of the inputs, so the result of an example does not depend on the others. O(examples x
/// weights), 5 to 10 weights per ns.
void evaluate(const DenseNetwork& network, std::span<const float* const> inputs, std::span<float> log_odds);

/// Writes a network of a kind (network_text.hpp); numbers have four significant digits.
std::string as_text(const DenseNetwork& network, std::string_view kind);
/// Throws Error{input} naming `where` if the text is not a network of that kind with one output.
DenseNetwork parse_dense_network(std::string_view text, std::string_view kind, const std::string& where);

/// Training examples; `targets` is the target probability of each, [0, 1].
struct NetworkExamples {
  int inputs = 0;
  std::vector<float> values;  ///< example by example
  std::vector<float> targets;
};

struct NetworkTraining {
  std::vector<int> hidden{32, 16};
  int rounds = 8;        ///< epochs
  int batch_size = 256;  ///< batch size
  double rate = 3e-3;    ///< initial learning rate; decays as a cosine
  std::uint64_t seed = 1;
};

/// Minimises cross entropy with Adam (Kingma & Ba 2015). Deterministic for the same examples and seed.
/// `progress` receives the mean loss after each epoch.
DenseNetwork train_network(const NetworkExamples& examples, const NetworkTraining& training,
                           const std::function<void(int round, double loss)>& progress = {});

}  // namespace waymark::pipeline
