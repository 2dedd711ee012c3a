// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "core/error.hpp"
#include "pipeline/craters/crater_model.hpp"

namespace waymark {
namespace {

constexpr std::string_view kFirstLine = "waymark crater model 1";
constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr int kLevels = 32000;  // a weight is a sixteen-bit share of the largest of its output

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

void read_output(CraterModel::Layer& layer, Lines& lines) {
  std::string_view line = lines.next();
  const auto bias = number<float>(line, lines), largest = number<float>(line, lines);
  if (!std::isfinite(bias) || !std::isfinite(largest)) lines.fail("a number is not finite");
  if (line.empty() || line.front() != ' ') lines.fail("weights are missing");
  line.remove_prefix(1);
  if (line.size() != 3 * static_cast<std::size_t>(layer.inputs))
    lines.fail(fmt::format("{} weights where {} belong", line.size() / 3, layer.inputs));
  layer.biases.push_back(bias);
  for (std::size_t i = 0; i < line.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto digit = kDigits.find(line[i + k]);
      if (digit == std::string_view::npos)
        lines.fail(fmt::format("'{}' is no digit of a weight", line[i + k]));
      bits = bits << 6U | static_cast<unsigned>(digit);
    }
    layer.weights.push_back(largest * static_cast<float>(static_cast<int>(bits) - 32768) / kLevels);
  }
}

}  // namespace

std::string as_text(const CraterModel& model) {
  std::string text = fmt::format("{}\n{}\n", kFirstLine, model.trained_on);
  for (const CraterModel::Layer& layer : model.layers) {
    text += fmt::format("layer {} {}\n", layer.inputs, layer.outputs);
    for (int o = 0; o < layer.outputs; ++o) {
      const float* weights = layer.weights.data() + static_cast<std::ptrdiff_t>(o) * layer.inputs;
      float largest = 1e-30F;
      for (int i = 0; i < layer.inputs; ++i) largest = std::max(largest, std::abs(weights[i]));
      text += fmt::format("{} {} ", layer.biases[static_cast<std::size_t>(o)], largest);
      for (int i = 0; i < layer.inputs; ++i)
        append(text, static_cast<int>(std::lround(weights[i] / largest * kLevels)));
      text += '\n';
    }
  }
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
    if (!line.starts_with("layer ")) lines.fail("'layer INPUTS OUTPUTS' belongs here");
    line.remove_prefix(6);
    CraterModel::Layer layer;
    layer.inputs = number<int>(line, lines), layer.outputs = number<int>(line, lines);
    if (layer.inputs != inputs)
      lines.fail(fmt::format("a layer of {} inputs follows {} outputs", layer.inputs, inputs));
    if (layer.outputs < 1 || layer.outputs > 4096) lines.fail("a layer has 1 to 4096 outputs");
    for (int o = 0; o < layer.outputs; ++o) read_output(layer, lines);
    inputs = layer.outputs;
    model.layers.push_back(std::move(layer));
  }
  if (model.layers.empty() || inputs != 4) lines.fail("the last layer must have 4 outputs");
  return model;
}

}  // namespace waymark
