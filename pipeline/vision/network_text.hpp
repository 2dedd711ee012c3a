// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>
namespace waymark::pipeline {

/// Layer of a network as it is stored. `shape` is INPUTS OUTPUTS of a dense layer, and SIDE CHANNELS SCALARS
/// KERNEL STRIDE OUTPUTS of a convolution.
struct StoredLayer {
  std::vector<int> shape;
  std::vector<double> biases;   ///< one per output
  std::vector<double> weights;  ///< output by output

  bool is_dense() const { return shape.size() == 2; }
  int inputs() const { return is_dense() ? shape[0] : shape[3] * shape[3] * shape[1] + shape[2]; }
  int outputs() const { return shape.back(); }
};

/// Numbers of a trained model. What they mean is the business of the model that reads them.
struct StoredNetwork {
  std::string kind;                   ///< what it was trained for: "craters", "crowns", "rocks", "treetops"
  std::string trained_on;             ///< provenance, one line of text
  double prior = 0;                   ///< fraction of the class among the training examples; 0: not stated
  std::vector<double> centre, scale;  ///< per input: (value - centre) / scale; empty: none
  std::vector<StoredLayer> layers;
};

/// How weights are written: with `digits` significant digits, or packed as sixteen-bit fractions of the
/// largest of their output in three base-64 digits each, if `digits` is 0.
struct NumberFormat {
  int digits = 4;
};

/// Writes a model as text, version 2:
/// - `waymark network 2 KIND`, and a line of provenance;
/// - `numbers decimal` or `numbers packed`;
/// - `prior P`, if it is stated;
/// - `inputs N` with a line of centres and one of scales, if inputs are standardised;
/// - `layer INPUTS OUTPUTS` or `convolution SIDE CHANNELS SCALARS KERNEL STRIDE OUTPUTS`, and a line per
///   output: its bias and its weights (packed: its bias, its largest weight, the digits);
/// - `check HEX`, the FNV-1a hash of all lines above.
std::string network_as_text(const StoredNetwork& network, NumberFormat format);

/// Returns what is wrong with the sizes of a layer that follows the layers `before`; empty: nothing.
using LayerCheck = std::function<std::string(std::span<const StoredLayer> before, const StoredLayer& layer)>;

/// Returns a check that there are only dense layers, each with as many inputs as the one before has outputs;
/// the first has `inputs`.
LayerCheck dense_layers_of(int inputs);

/// Reads version 2 and the two formats of version 1: `waymark crater model 1` and `dense_network 1`, which
/// have no check. Throws Error{input} that names `where`, the line and the problem, also for a model of
/// another kind or a layer that `check` refuses.
StoredNetwork parse_network(std::string_view text, std::string_view kind, const std::string& where,
                            const LayerCheck& check = {});

/// Converts numbers to single precision.
std::vector<float> as_floats(std::span<const double> numbers);

/// Throws Error{input}: the model in `where` is none of `kind`, because of `problem`.
[[noreturn]] void refuse_network(std::string_view kind, const std::string& problem, const std::string& where);

}  // namespace waymark::pipeline
