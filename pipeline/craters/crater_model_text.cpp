// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "core/error.hpp"
#include "pipeline/craters/crater_model.hpp"

namespace waymark::pipeline {
namespace {

constexpr std::string_view kFirstLine = "waymark crater model 1";
constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr int kLevels = 32000;  // a weight is a sixteen-bit fraction of the largest of its output

// Three digits of six bits for each number of -32768 to 32767.
void append(std::string& text, int number) {
  const auto bits = static_cast<unsigned>(number + 32768);
  for (const int shift : {12, 6, 0}) text += kDigits[(bits >> static_cast<unsigned>(shift)) & 63U];
}

class Lines {
 public:
  Lines(std::string_view text, std::string where) : rest_(text), where_(std::move(where)) {}

  std::string_view next() {
    ++line_;
    if (rest_.empty()) fail("the file ends too early");
    const auto end = std::min(rest_.find('\n'), rest_.size());
    const auto line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(rest_.size(), end + 1));
    return line;
  }
  [[noreturn]] void fail(const std::string& problem) const {
    throw Error(ErrorCode::input, "this is no crater model: " + problem,
                fmt::format("{}, line {}", where_, line_),
                "make one with `waymark train craters -o model.txt`");
  }
  bool at_end() const { return rest_.empty(); }

 private:
  std::string_view rest_;
  std::string where_;
  int line_ = 0;
};

template <class Number>
Number number(std::string_view& words, const Lines& lines) {
  while (!words.empty() && words.front() == ' ') words.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(words.data(), words.data() + words.size(), value);
  if (error != std::errc{}) lines.fail("a number is missing");
  words.remove_prefix(static_cast<std::size_t>(end - words.data()));
  return value;
}

// Weights of one output.
struct Output {
  float bias = 0;
  std::vector<float> weights;
};

Output read_output(int inputs, Lines& lines) {
  std::string_view line = lines.next();
  Output output;
  output.bias = number<float>(line, lines);
  const auto largest = number<float>(line, lines);
  if (!std::isfinite(output.bias) || !std::isfinite(largest)) lines.fail("a number is not finite");
  if (line.empty() || line.front() != ' ') lines.fail("weights are missing");
  line.remove_prefix(1);
  if (line.size() != 3 * static_cast<std::size_t>(inputs))
    lines.fail(fmt::format("{} weights where {} belong", line.size() / 3, inputs));
  for (std::size_t i = 0; i < line.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto digit = kDigits.find(line[i + k]);
      if (digit == std::string_view::npos)
        lines.fail(fmt::format("'{}' is no digit of a weight", line[i + k]));
      bits = bits << 6U | static_cast<unsigned>(digit);
    }
    output.weights.push_back(largest * static_cast<float>(static_cast<int>(bits) - 32768) / kLevels);
  }
  return output;
}

void write_output(std::string& text, const Output& output) {
  float largest = 1e-30F;
  for (const float weight : output.weights) largest = std::max(largest, std::abs(weight));
  text += fmt::format("{} {} ", output.bias, largest);
  for (const float weight : output.weights)
    append(text, static_cast<int>(std::lround(weight / largest * kLevels)));
  text += '\n';
}

void write_convolution(std::string& text, const Convolution& c) {
  text += fmt::format("convolution {} {} {} {} {} {}\n", c.side, c.channels, c.scalars, c.kernel, c.stride,
                      c.outputs);
  const auto outputs = static_cast<std::size_t>(c.outputs);
  for (std::size_t o = 0; o < outputs; ++o) {
    Output output{c.biases[o], {}};
    for (std::size_t i = o; i < c.weights.size(); i += outputs) output.weights.push_back(c.weights[i]);
    write_output(text, output);
  }
}

// `words`: the line after its name. The input must have the size of the previous layer's output.
Convolution read_convolution(std::string_view words, const ConvolutionNet& before, Lines& lines) {
  Convolution c;
  for (int* value : {&c.side, &c.channels, &c.scalars, &c.kernel, &c.stride, &c.outputs})
    *value = number<int>(words, lines);
  const int side = before.empty() ? kWidePatchSide : before.back().out_side(),
            channels = before.empty() ? 1 : before.back().outputs;
  if (c.side != side || c.channels != channels)
    lines.fail(fmt::format("a convolution of {0} x {0} x {1} follows {2} x {2} x {3}", c.side, c.channels,
                           side, channels));
  if (c.kernel < 1 || c.kernel > c.side || c.stride < 1)
    lines.fail("a kernel is 1 to SIDE wide, a stride 1 or more");
  if (c.scalars != 0 && (c.scalars != kScalarInputs || c.kernel != c.side))
    lines.fail(fmt::format("{} facts go into a convolution as wide as its input, or none", kScalarInputs));
  if (std::find(kConvolutionOutputs.begin(), kConvolutionOutputs.end(), c.outputs) ==
      kConvolutionOutputs.end())
    lines.fail("a convolution has 4, 8, 16 or 32 outputs");
  const auto inputs = static_cast<std::size_t>(c.inputs()), outputs = static_cast<std::size_t>(c.outputs);
  c.weights.resize(inputs * outputs);
  for (std::size_t o = 0; o < outputs; ++o) {
    const Output output = read_output(c.inputs(), lines);
    c.biases.push_back(output.bias);
    for (std::size_t i = 0; i < inputs; ++i) c.weights[i * outputs + o] = output.weights[i];
  }
  return c;
}

bool complete(const ConvolutionNet& net) {
  return !net.empty() && net.back().outputs == 4 && net.back().out_side() == 1;
}

}  // namespace

std::string as_text(const CraterModel& model) {
  std::string text = fmt::format("{}\n{}\n", kFirstLine, model.trained_on);
  for (const CraterModel::Layer& layer : model.layers) {
    text += fmt::format("layer {} {}\n", layer.inputs, layer.outputs);
    for (int o = 0; o < layer.outputs; ++o) {
      const auto weights = layer.weights.begin() + static_cast<std::ptrdiff_t>(o) * layer.inputs;
      write_output(text, {layer.biases[static_cast<std::size_t>(o)], {weights, weights + layer.inputs}});
    }
  }
  for (const ConvolutionNet& net : model.convolution_nets)
    for (const Convolution& convolution : net) write_convolution(text, convolution);
  return text;
}

CraterModel parse_crater_model(std::string_view text, const std::string& where) {
  Lines lines(text, where);
  if (lines.next() != kFirstLine) lines.fail(fmt::format("it does not begin with '{}'", kFirstLine));
  CraterModel model;
  model.trained_on = lines.next();
  int inputs = kCraterFeatures;
  while (!lines.at_end()) {
    std::string_view line = lines.next();
    if (line.starts_with("convolution ")) {
      line.remove_prefix(12);
      if (model.convolution_nets.empty() || complete(model.convolution_nets.back()))
        model.convolution_nets.emplace_back();
      model.convolution_nets.back().push_back(read_convolution(line, model.convolution_nets.back(), lines));
      continue;
    }
    if (!line.starts_with("layer ") || !model.convolution_nets.empty())
      lines.fail("'layer INPUTS OUTPUTS' belongs here");
    line.remove_prefix(6);
    CraterModel::Layer layer;
    layer.inputs = number<int>(line, lines), layer.outputs = number<int>(line, lines);
    if (layer.inputs != inputs)
      lines.fail(fmt::format("a layer of {} inputs follows {} outputs", layer.inputs, inputs));
    if (layer.outputs < 1 || layer.outputs > 4096) lines.fail("a layer has 1 to 4096 outputs");
    for (int o = 0; o < layer.outputs; ++o) {
      const Output output = read_output(layer.inputs, lines);
      layer.biases.push_back(output.bias);
      layer.weights.insert(layer.weights.end(), output.weights.begin(), output.weights.end());
    }
    inputs = layer.outputs;
    model.layers.push_back(std::move(layer));
  }
  if (model.layers.empty() || inputs != 4) lines.fail("the last layer must have 4 outputs");
  if (!model.convolution_nets.empty() && !complete(model.convolution_nets.back()))
    lines.fail("the last convolution must give 4 outputs at one place");
  return model;
}

}  // namespace waymark::pipeline
