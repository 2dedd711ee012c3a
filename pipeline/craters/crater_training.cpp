// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/crater_training.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/random.hpp"
#include "pipeline/craters/bowl_candidates.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kClear = 0.4;

// A layer with its gradients and Adam's moments.
struct LayerState {
  CraterModel::Layer layer;
  std::vector<float> gradient, mean, square;  // weights, then biases
  std::vector<float> in, out, back;
};

LayerState make_layer(int inputs, int outputs, Random& random) {
  LayerState l;
  l.layer = {inputs, outputs, {}, std::vector<float>(static_cast<std::size_t>(outputs), 0.0F)};
  const double deviation = std::sqrt(2.0 / inputs);
  for (int i = 0; i < inputs * outputs; ++i)
    l.layer.weights.push_back(static_cast<float>(random.normal(0, deviation)));
  const std::size_t all = l.layer.weights.size() + l.layer.biases.size();
  l.gradient.assign(all, 0), l.mean.assign(all, 0), l.square.assign(all, 0);
  return l;
}

void forward(LayerState& l, const std::vector<float>& in, bool last) {
  l.in = in;
  l.out = l.layer.biases;
  const float* weight = l.layer.weights.data();
  for (float& sum : l.out) {
    float total = 0;
    for (const float value : in) total += *weight++ * value;
    sum += total;
    if (!last && sum < 0) sum *= 0.1F;
  }
}

// `error`: gradient of the loss by the sums of the layer; stores that by its inputs in `back`.
void backward(LayerState& l, const std::vector<float>& error) {
  l.back.assign(l.in.size(), 0);
  float* gradient = l.gradient.data();
  const float* weight = l.layer.weights.data();
  for (const float e : error)
    for (std::size_t i = 0; i < l.in.size(); ++i) {
      *gradient++ += e * l.in[i];
      l.back[i] += e * *weight++;
    }
  for (const float e : error) *gradient++ += e;
}

void step(LayerState& l, double rate, double decay, int step_count, double examples) {
  const double correct1 = 1 - std::pow(0.9, step_count), correct2 = 1 - std::pow(0.999, step_count);
  const std::size_t weights = l.layer.weights.size();
  for (std::size_t i = 0; i < l.gradient.size(); ++i) {
    const double g = l.gradient[i] / examples;
    l.mean[i] = static_cast<float>(0.9 * l.mean[i] + 0.1 * g);
    l.square[i] = static_cast<float>(0.999 * l.square[i] + 0.001 * g * g);
    float& value = i < weights ? l.layer.weights[i] : l.layer.biases[i - weights];
    const double move = l.mean[i] / correct1 / (std::sqrt(l.square[i] / correct2) + 1e-8);
    value -= static_cast<float>(rate * (move + (i < weights ? decay * value : 0)));
    l.gradient[i] = 0;
  }
}

// Computes the gradient of the loss by the four outputs; returns the loss.
double loss_gradient(const std::vector<float>& out, const CraterExample& example, std::vector<float>& error) {
  const double p = 1 / (1 + std::exp(-double(out[0])));
  error[0] = static_cast<float>(p - (example.crater ? 1 : 0));
  double loss = -std::log(std::max(1e-9, example.crater ? p : 1 - p));
  const float wanted[] = {10 * example.along, 10 * example.across, 10 * example.log_size};
  for (std::size_t i = 0; i < 3; ++i) {
    // Huber loss, so that candidates on the wrong crater do not dominate.
    const float off = example.crater ? out[i + 1] - wanted[i] : 0;
    error[i + 1] = 0.3F * std::clamp(off, -1.0F, 1.0F);
    loss += 0.3 * (std::abs(off) < 1 ? 0.5 * off * off : std::abs(off) - 0.5);
  }
  return loss;
}

}  // namespace

MatchedCrater match_crater(const LabelledScene& scene, const CraterCandidate& circle) {
  MatchedCrater best;
  for (const LabelledCrater& k : scene.craters) {
    if (std::hypot(k.x - circle.x, k.y - circle.y) > (k.diameter + circle.diameter) / 2) continue;
    const double common = overlap(circle, {k.x, k.y, k.diameter, 0});
    if (common > best.overlap) best = {&k, common};
  }
  return best;
}

std::vector<CraterExample> make_crater_examples(const LabelledScene& scene, std::uint64_t seed) {
  Random random(seed, "crater examples");
  const double side = double(std::min(scene.image.columns(), scene.image.rows()));
  const auto found = suppress_overlaps(
      bowl_candidates(scene.image,
                      {.sun_angle = scene.sun_angle,
                       .limits = {.min_diameter = 7, .max_diameter = 0.6 * side, .min_correlation = 0.5}}),
      0.5);
  const PatchSource source(scene.image, scene.sun_angle);
  std::vector<CraterExample> examples;
  for (CraterCandidate c : found) {
    const double correlation = c.score;
    // Perturbed as by rounds of correction.
    if (random.bernoulli(0.5))
      c.x += random.normal(0, 0.04) * c.diameter, c.y += random.normal(0, 0.04) * c.diameter,
          c.diameter *= std::exp(random.normal(0, 0.08));
    const auto [best, common] = match_crater(scene, c);
    const bool crater = common >= 0.45 && best->clarity >= kClear;
    if (!crater && common > 0.25) continue;
    if (!crater && random.bernoulli(0.5)) continue;
    const double dx = best ? (best->x - c.x) / c.diameter : 0, dy = best ? (best->y - c.y) / c.diameter : 0;
    const double cosine = std::cos(scene.sun_angle.value), sine = std::sin(scene.sun_angle.value);
    for (const bool mirrored : {false, true}) {
      CraterExample e{source.features(c, correlation, mirrored), crater, 0, 0, 0};
      if (crater) {
        e.along = static_cast<float>(dx * cosine + dy * sine);
        e.across = static_cast<float>((mirrored ? -1 : 1) * (dy * cosine - dx * sine));
        e.log_size = static_cast<float>(std::log(best->diameter / c.diameter));
      }
      examples.push_back(e);
    }
  }
  return examples;
}

CraterModel train_crater_model(std::span<const CraterExample> examples, const CraterTraining& training,
                               const std::function<void(int, double)>& progress) {
  Random random(training.seed, "crater training");
  std::vector<LayerState> layers;
  std::vector<int> sizes{kCraterFeatures};
  sizes.insert(sizes.end(), training.hidden.begin(), training.hidden.end());
  sizes.push_back(4);
  for (std::size_t i = 0; i + 1 < sizes.size(); ++i)
    layers.push_back(make_layer(sizes[i], sizes[i + 1], random));

  std::vector<std::size_t> order(examples.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  constexpr std::size_t batch = 64;
  int steps = 0;
  const double all_steps = double(training.rounds) * double(order.size() / batch + 1);
  for (int round = 0; round < training.rounds; ++round) {
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.uniform_index(i)]);
    double loss = 0;
    for (std::size_t begin = 0; begin < order.size(); begin += batch) {
      const std::size_t end = std::min(begin + batch, order.size());
      for (std::size_t i = begin; i < end; ++i) {
        const CraterExample& example = examples[order[i]];
        std::vector<float> in(example.features.begin(), example.features.end());
        for (LayerState& l : layers) {
          forward(l, in, &l == &layers.back());
          in = l.out;
        }
        std::vector<float> error(4);
        loss += loss_gradient(in, example, error);
        for (std::size_t l = layers.size(); l-- > 0;) {
          backward(layers[l], error);
          error = layers[l].back;
          if (l > 0)
            for (std::size_t k = 0; k < error.size(); ++k)
              if (layers[l - 1].out[k] < 0) error[k] *= 0.1F;
        }
      }
      const double rate = 2e-3 * 0.5 * (1 + std::cos(std::numbers::pi * steps / all_steps));
      ++steps;
      for (LayerState& l : layers) step(l, rate, training.decay, steps, double(end - begin));
    }
    if (progress) progress(round, loss / double(std::max<std::size_t>(1, order.size())));
  }
  CraterModel model;
  for (LayerState& l : layers) model.layers.push_back(std::move(l.layer));
  return model;
}

}  // namespace waymark::pipeline
