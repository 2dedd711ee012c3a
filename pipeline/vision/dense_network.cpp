// SPDX-License-Identifier: Apache-2.0
#include "pipeline/vision/dense_network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "core/error.hpp"

namespace waymark::pipeline {
namespace {

constexpr std::size_t kBatch = 256;  // examples whose values fit in the L1 cache

/// Reads numbers from text.
class Words {
 public:
  Words(std::string_view text, const std::string& where) : text_(text), where_(where) {}

  template <class T>
  T number(const char* what) {
    skip();
    T value{};
    const auto [end, problem] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    if (problem != std::errc()) fail(what);
    text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
    return value;
  }
  std::vector<float> numbers(std::size_t count, const char* what) {
    std::vector<float> all(count);
    for (float& value : all) value = number<float>(what);
    return all;
  }
  std::string_view line() {
    const std::size_t end = std::min(text_.find('\n'), text_.size());
    const std::string_view found = text_.substr(0, end);
    text_.remove_prefix(std::min(end + 1, text_.size()));
    return found;
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::input, fmt::format("not a network: {} is missing", what), where_);
  }

 private:
  void skip() { text_.remove_prefix(std::min(text_.find_first_not_of(" \n"), text_.size())); }
  std::string_view text_;
  const std::string& where_;
};

void add_numbers(std::string& text, std::span<const float> numbers) {
  for (const float value : numbers) text += fmt::format("{:.4g} ", value);
  text.back() = '\n';
}

}  // namespace

void evaluate(const DenseNetwork& network, std::span<const float* const> inputs, std::span<float> log_odds) {
  std::vector<float> in, out;
  for (std::size_t first = 0; first < log_odds.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, log_odds.size() - first);
    in.resize(inputs.size() * count);
    for (std::size_t i = 0; i < inputs.size(); ++i)
      for (std::size_t x = 0; x < count; ++x)
        in[i * count + x] = (inputs[i][first + x] - network.centre[i]) / network.scale[i];
    for (const auto& layer : network.layers) {
      const auto width = static_cast<std::size_t>(layer.inputs);
      out.resize(layer.biases.size() * count);
      for (std::size_t o = 0; o < layer.biases.size(); ++o) {
        float* const sum = out.data() + o * count;
        std::fill_n(sum, count, layer.biases[o]);
        for (std::size_t i = 0; i < width; ++i) {
          const float weight = layer.weights[o * width + i];
          const float* const value = in.data() + i * count;
          for (std::size_t x = 0; x < count; ++x) sum[x] += weight * value[x];
        }
      }
      if (&layer != &network.layers.back())
        for (float& value : out) value = std::max(value, 0.0F);
      in.swap(out);
    }
    std::copy_n(in.begin(), count, log_odds.begin() + static_cast<std::ptrdiff_t>(first));
  }
}

std::string as_text(const DenseNetwork& network) {
  std::string text = fmt::format("dense_network 1\n{}\n{} {}\n", network.trained_on, network.centre.size(),
                                 network.layers.size());
  add_numbers(text, network.centre);
  add_numbers(text, network.scale);
  for (const auto& layer : network.layers) {
    text += fmt::format("{}\n", layer.outputs);
    add_numbers(text, layer.weights);
    add_numbers(text, layer.biases);
  }
  return text;
}

DenseNetwork parse_dense_network(std::string_view text, const std::string& where) {
  Words words(text, where);
  if (words.line() != "dense_network 1") words.fail("its first line, dense_network 1,");
  DenseNetwork network;
  network.trained_on = words.line();
  const int inputs = words.number<int>("the number of inputs"), layers = words.number<int>("that of layers");
  if (inputs < 1 || inputs > 10'000 || layers < 1 || layers > 20) words.fail("a sensible size");
  network.centre = words.numbers(static_cast<std::size_t>(inputs), "a centre");
  network.scale = words.numbers(static_cast<std::size_t>(inputs), "a scale");
  if (std::ranges::any_of(network.scale, [](float s) { return !(s > 0); })) words.fail("a scale above 0");
  for (int i = 0, width = inputs; i < layers; ++i) {
    DenseNetwork::Layer layer{
        .inputs = width, .outputs = words.number<int>("a layer"), .weights = {}, .biases = {}};
    if (layer.outputs < 1 || layer.outputs > 10'000) words.fail("a sensible layer");
    const auto outputs = static_cast<std::size_t>(layer.outputs);
    layer.weights = words.numbers(outputs * static_cast<std::size_t>(width), "a weight");
    layer.biases = words.numbers(outputs, "a bias");
    width = layer.outputs;
    network.layers.push_back(std::move(layer));
  }
  if (network.layers.back().outputs != 1) words.fail("a last layer of one output");
  return network;
}

}  // namespace waymark::pipeline
