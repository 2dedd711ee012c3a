// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>
namespace waymark {

/// A small network of dense layers with rectifiers between them and one output, the log odds that something
/// is what it was trained to tell. Inputs are standardized: (value - centre) / scale.
struct DenseNetwork {
  struct Layer {
    int inputs = 0, outputs = 0;
    std::vector<float> weights;  ///< output by output
    std::vector<float> biases;
    friend bool operator==(const Layer&, const Layer&) = default;
  };
  std::vector<float> centre, scale;  ///< of each input
  std::vector<Layer> layers;         ///< the last has one output
  std::string trained_on;            ///< one line, for people

  friend bool operator==(const DenseNetwork&, const DenseNetwork&) = default;
};

/// Log odds of `log_odds.size()` examples at once: inputs[i] points at their values of input i. Sums run in
/// the order of the inputs, so an example gets the same bits among whatever others.
/// O(examples x weights), 5 to 10 weights per ns.
void evaluate(const DenseNetwork& network, std::span<const float* const> inputs, std::span<float> log_odds);

/// Text that parse_dense_network reads back; numbers with four digits, which is what `rounded` leaves.
std::string as_text(const DenseNetwork& network);
/// Throws Error{input} naming `where`.
DenseNetwork parse_dense_network(std::string_view text, const std::string& where);

/// What a network learns from: `wanted` is the probability each example should get, [0, 1].
struct NetworkExamples {
  int inputs = 0;
  std::vector<float> values;  ///< example by example
  std::vector<float> wanted;
};

struct NetworkTraining {
  std::vector<int> hidden{32, 16};
  int rounds = 8;      ///< times through all examples
  int together = 256;  ///< examples per step
  double rate = 3e-3;  ///< of the first step; falls as a cosine
  std::uint64_t seed = 1;
};

/// Least cross entropy by Adam (Kingma & Ba 2015). The same examples and seed give the same network.
/// `progress` is told the mean loss after each round.
DenseNetwork train_network(const NetworkExamples& examples, const NetworkTraining& training,
                           const std::function<void(int round, double loss)>& progress = {});

}  // namespace waymark
