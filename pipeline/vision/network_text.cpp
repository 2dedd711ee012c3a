// SPDX-License-Identifier: Apache-2.0
#include "pipeline/vision/network_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <span>

#include "core/error.hpp"

namespace waymark::pipeline {
namespace {

constexpr std::string_view kVersion2 = "waymark network 2 ", kCraters1 = "waymark crater model 1",
                           kCrowns1 = "dense_network 1";
constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr int kLevels = 32000;  // a packed weight is a sixteen-bit fraction of the largest of its output
constexpr int kMaxWidth = 10'000, kMaxLayers = 100;

std::uint32_t hash_of(std::string_view text) {
  std::uint32_t hash = 2166136261U;  // FNV-1a
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
  return hash;
}

class NetworkLines {
 public:
  NetworkLines(std::string_view text, std::string_view kind, const std::string& where)
      : text_(text), rest_(text), kind_(kind), where_(where) {}

  bool at_end() const { return rest_.empty(); }
  bool next_begins(std::string_view word) const { return rest_.starts_with(word); }
  std::string_view before() const { return text_.substr(0, text_.size() - rest_.size()); }
  std::string_view next() {
    ++line_;
    if (rest_.empty()) fail("the file ends too early");
    const auto end = std::min(rest_.find('\n'), rest_.size());
    const auto line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(rest_.size(), end + 1));
    return line;
  }
  [[noreturn]] void fail(const std::string& problem) const {
    refuse_network(kind_, problem, fmt::format("{}, line {}", where_, line_));
  }

 private:
  std::string_view text_, rest_, kind_;
  const std::string& where_;
  int line_ = 0;
};

template <class Number>
Number take_number(std::string_view& words, const NetworkLines& lines) {
  while (!words.empty() && words.front() == ' ') words.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(words.data(), words.data() + words.size(), value);
  if (error != std::errc{}) lines.fail("a number is missing");
  words.remove_prefix(static_cast<std::size_t>(end - words.data()));
  if constexpr (std::is_floating_point_v<Number>)
    if (!std::isfinite(value)) lines.fail("a number is not finite");
  return value;
}

void end_line(std::string_view words, const NetworkLines& lines) {
  if (words.find_first_not_of(' ') != std::string_view::npos)
    lines.fail(fmt::format("'{}' is too much", words.substr(words.find_first_not_of(' '), 20)));
}

std::vector<double> take_numbers(std::string_view line, int count, const NetworkLines& lines) {
  std::vector<double> numbers;
  for (int i = 0; i < count; ++i) numbers.push_back(take_number<double>(line, lines));
  end_line(line, lines);
  return numbers;
}

void unpack(std::string_view line, int inputs, std::vector<double>& weights, const NetworkLines& lines) {
  const auto largest = take_number<float>(line, lines);
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
    // In single precision, as the numbers are used.
    weights.push_back(
        static_cast<double>(largest * static_cast<float>(static_cast<int>(bits) - 32768) / kLevels));
  }
}

void read_outputs(StoredLayer& layer, bool packed, NetworkLines& lines) {
  for (int o = 0; o < layer.outputs(); ++o) {
    std::string_view line = lines.next();
    layer.biases.push_back(take_number<double>(line, lines));
    if (packed) {
      unpack(line, layer.inputs(), layer.weights, lines);
      continue;
    }
    const auto weights = take_numbers(line, layer.inputs(), lines);
    layer.weights.insert(layer.weights.end(), weights.begin(), weights.end());
  }
}

StoredLayer read_shape(NetworkLines& lines) {
  std::string_view line = lines.next();
  StoredLayer layer;
  const bool dense = line.starts_with("layer ");
  if (!dense && !line.starts_with("convolution ")) lines.fail("'layer INPUTS OUTPUTS' belongs here");
  line.remove_prefix(line.find(' '));
  for (int i = 0; i < (dense ? 2 : 6); ++i) {
    layer.shape.push_back(take_number<int>(line, lines));
    if (layer.shape.back() < 0 || layer.shape.back() > kMaxWidth)
      lines.fail(fmt::format("a size is 0 to {}", kMaxWidth));
  }
  end_line(line, lines);
  if (!dense && (layer.shape[3] < 1 || layer.shape[3] > layer.shape[0] || layer.shape[4] < 1))
    lines.fail("a kernel is 1 to SIDE wide, a stride 1 or more");
  const double inputs =
      dense ? layer.shape[0] : double(layer.shape[3]) * layer.shape[3] * layer.shape[1] + layer.shape[2];
  if (inputs < 1 || inputs > kMaxWidth || layer.outputs() < 1)
    lines.fail(fmt::format("a layer has 1 to {} inputs and outputs", kMaxWidth));
  return layer;
}

void read_layers(StoredNetwork& network, bool packed, const LayerCheck& check, NetworkLines& lines) {
  while (!lines.at_end() && !lines.next_begins("check ")) {
    StoredLayer layer = read_shape(lines);
    if (const std::string problem = check ? check(network.layers, layer) : ""; !problem.empty())
      lines.fail(problem);
    if (network.layers.size() == kMaxLayers) lines.fail(fmt::format("more than {} layers", kMaxLayers));
    read_outputs(layer, packed, lines);
    network.layers.push_back(std::move(layer));
  }
}

void read_standard_inputs(StoredNetwork& network, int inputs, NetworkLines& lines) {
  if (inputs < 1 || inputs > kMaxWidth) lines.fail(fmt::format("1 to {} inputs belong here", kMaxWidth));
  network.centre = take_numbers(lines.next(), inputs, lines);
  network.scale = take_numbers(lines.next(), inputs, lines);
  if (std::ranges::any_of(network.scale, [](double s) { return !(s > 0); }))
    lines.fail("a scale must be above 0");
}

StoredNetwork read_version_2(std::string_view kind, const LayerCheck& check, NetworkLines& lines) {
  const std::string_view found = lines.next().substr(kVersion2.size());
  if (found != kind) lines.fail(fmt::format("it is one of {}", found));
  StoredNetwork network;
  network.kind = kind;
  network.trained_on = lines.next();
  const std::string_view numbers = lines.next();
  if (numbers != "numbers decimal" && numbers != "numbers packed")
    lines.fail("'numbers decimal' or 'numbers packed' belongs here");
  if (lines.next_begins("prior ")) {
    network.prior = take_numbers(lines.next().substr(6), 1, lines)[0];
    if (!(network.prior > 0 && network.prior < 1)) lines.fail("a prior is between 0 and 1");
  }
  if (lines.next_begins("inputs ")) {
    std::string_view line = lines.next().substr(7);
    read_standard_inputs(network, take_number<int>(line, lines), lines);
  }
  read_layers(network, numbers == "numbers packed", check, lines);
  const std::uint32_t hash = hash_of(lines.before());
  if (lines.next() != fmt::format("check {:08x}", hash))
    lines.fail(fmt::format("its text is damaged: 'check {:08x}' belongs here", hash));
  if (!lines.at_end()) lines.fail("lines follow the check");
  return network;
}

// Version 1 of crowns: INPUTS LAYERS, centres, scales; per layer its outputs, all weights, all biases.
StoredNetwork read_crowns_1(const LayerCheck& check, NetworkLines& lines) {
  StoredNetwork network;
  network.kind = "crowns";
  network.trained_on = lines.next();
  std::string_view sizes = lines.next();
  int inputs = take_number<int>(sizes, lines);
  const int layers = take_number<int>(sizes, lines);
  if (layers < 1 || layers > kMaxLayers) lines.fail(fmt::format("1 to {} layers belong here", kMaxLayers));
  read_standard_inputs(network, inputs, lines);
  for (int i = 0; i < layers; ++i) {
    std::string_view line = lines.next();
    StoredLayer layer{.shape = {inputs, take_number<int>(line, lines)}, .biases = {}, .weights = {}};
    const int outputs = layer.outputs();
    if (outputs < 1 || outputs > kMaxWidth) lines.fail(fmt::format("a layer has 1 to {} outputs", kMaxWidth));
    if (const std::string problem = check ? check(network.layers, layer) : ""; !problem.empty())
      lines.fail(problem);
    layer.weights = take_numbers(lines.next(), inputs * outputs, lines);
    layer.biases = take_numbers(lines.next(), outputs, lines);
    inputs = outputs;
    network.layers.push_back(std::move(layer));
  }
  return network;
}

StoredNetwork read_craters_1(const LayerCheck& check, NetworkLines& lines) {
  StoredNetwork network;
  network.kind = "craters";
  network.trained_on = lines.next();
  read_layers(network, true, check, lines);
  return network;
}

std::string decimals(std::span<const double> numbers, int digits) {
  std::string text;
  for (const double number : numbers) text += fmt::format(" {:.{}g}", number, digits);
  return text;
}

// Sums of all that is packed are of single precision; so are the numbers here.
std::string packed_weights(std::span<const double> weights) {
  float largest = 1e-30F;
  for (const double weight : weights) largest = std::max(largest, std::abs(static_cast<float>(weight)));
  std::string text = fmt::format(" {} ", largest);
  for (const double weight : weights) {
    const auto bits =
        static_cast<unsigned>(std::lround(static_cast<float>(weight) / largest * kLevels) + 32768);
    for (const unsigned shift : {12U, 6U, 0U}) text += kDigits[(bits >> shift) & 63U];
  }
  return text;
}

}  // namespace

std::vector<float> as_floats(std::span<const double> numbers) {
  std::vector<float> all;
  for (const double number : numbers) all.push_back(static_cast<float>(number));
  return all;
}

void refuse_network(std::string_view kind, const std::string& problem, const std::string& where) {
  const std::string_view what = kind == "crowns" || kind == "treetops" ? "trees" : kind;
  throw Error(ErrorCode::input, fmt::format("this is no model of {}: {}", kind, problem), where,
              fmt::format("make one with `waymark train {} -o model.txt`", what));
}

LayerCheck dense_layers_of(int inputs) {
  return [inputs](std::span<const StoredLayer> before, const StoredLayer& layer) -> std::string {
    const int wanted = before.empty() ? inputs : before.back().outputs();
    if (!layer.is_dense()) return "'layer INPUTS OUTPUTS' belongs here";
    if (layer.inputs() != wanted)
      return fmt::format("a layer of {} inputs follows {} outputs", layer.inputs(), wanted);
    return "";
  };
}

std::string network_as_text(const StoredNetwork& network, NumberFormat format) {
  const bool packed = format.digits == 0;
  std::string text = fmt::format("{}{}\n{}\nnumbers {}\n", kVersion2, network.kind, network.trained_on,
                                 packed ? "packed" : "decimal");
  if (network.prior > 0) text += fmt::format("prior {:.4g}\n", network.prior);
  if (!network.centre.empty()) {
    text += fmt::format("inputs {}\n", network.centre.size());
    for (const auto* numbers : {&network.centre, &network.scale})
      text += decimals(*numbers, packed ? 9 : format.digits).substr(1) + '\n';
  }
  for (const StoredLayer& layer : network.layers) {
    text += layer.is_dense() ? "layer" : "convolution";
    for (const int size : layer.shape) text += fmt::format(" {}", size);
    text += '\n';
    const auto inputs = static_cast<std::size_t>(layer.inputs());
    for (std::size_t o = 0; o < layer.biases.size(); ++o) {
      const auto weights = std::span(layer.weights).subspan(o * inputs, inputs);
      text += packed ? fmt::format("{}{}\n", static_cast<float>(layer.biases[o]), packed_weights(weights))
                     : fmt::format("{:.{}g}{}\n", layer.biases[o], format.digits,
                                   decimals(weights, format.digits));
    }
  }
  return text + fmt::format("check {:08x}\n", hash_of(text));
}

StoredNetwork parse_network(std::string_view text, std::string_view kind, const std::string& where,
                            const LayerCheck& check) {
  NetworkLines lines(text, kind, where);
  if (lines.next_begins(kVersion2)) return read_version_2(kind, check, lines);
  const std::string_view first = lines.next();
  if (kind == "craters" && first == kCraters1) return read_craters_1(check, lines);
  if (kind == "crowns" && first == kCrowns1) return read_crowns_1(check, lines);
  lines.fail(fmt::format("it does not begin with '{}{}'", kVersion2, kind));
}

}  // namespace waymark::pipeline
