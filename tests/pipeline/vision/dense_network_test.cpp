// SPDX-License-Identifier: Apache-2.0
#include "pipeline/vision/dense_network.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "core/random.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

DenseNetwork random_network(std::uint64_t seed, const std::vector<int>& sizes) {
  Random random(seed, "random network");
  DenseNetwork network;
  network.trained_on = "nothing";
  for (int i = 0; i < sizes[0]; ++i) {
    network.centre.push_back(static_cast<float>(random.normal()));
    network.scale.push_back(static_cast<float>(random.uniform(0.1, 3)));
  }
  for (std::size_t l = 0; l + 1 < sizes.size(); ++l) {
    DenseNetwork::Layer layer{sizes[l], sizes[l + 1], {}, {}};
    for (int i = 0; i < sizes[l] * sizes[l + 1]; ++i)
      layer.weights.push_back(static_cast<float>(random.normal()));
    for (int i = 0; i < sizes[l + 1]; ++i) layer.biases.push_back(static_cast<float>(random.normal()));
    network.layers.push_back(layer);
  }
  return network;
}

/// Evaluates one example by the definition.
double evaluate_by_definition(const DenseNetwork& network, const std::vector<float>& example) {
  std::vector<double> in;
  for (std::size_t i = 0; i < example.size(); ++i)
    in.push_back((double(example[i]) - double(network.centre[i])) / double(network.scale[i]));
  for (std::size_t l = 0; l < network.layers.size(); ++l) {
    std::vector<double> out;
    for (std::size_t o = 0; o < network.layers[l].biases.size(); ++o) {
      double sum = double(network.layers[l].biases[o]);
      for (std::size_t i = 0; i < in.size(); ++i)
        sum += double(network.layers[l].weights[o * in.size() + i]) * in[i];
      out.push_back(l + 1 < network.layers.size() ? std::max(sum, 0.0) : sum);
    }
    in = out;
  }
  return in[0];
}

TEST(DenseNetwork, GivesWhatThePlainSumGivesAndTheSameBitsInAnyCompany) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const DenseNetwork network = random_network(seed, {7, 13, 5, 1});
    Random random(seed, "inputs");
    std::vector<std::vector<float>> inputs(7, std::vector<float>(600));
    for (auto& input : inputs)
      for (float& value : input) value = static_cast<float>(random.normal(0, 2));
    std::vector<const float*> all;
    for (const auto& input : inputs) all.push_back(input.data());
    std::vector<float> odds(600);
    evaluate(network, all, odds);
    for (std::size_t x = 0; x < odds.size(); x += 37) {
      std::vector<float> example;
      std::vector<const float*> alone;
      for (const auto& input : inputs) example.push_back(input[x]), alone.push_back(&input[x]);
      EXPECT_NEAR(odds[x], evaluate_by_definition(network, example), 1e-3 * (1 + std::abs(odds[x])));
      float single = 0;
      evaluate(network, alone, {&single, 1});
      EXPECT_EQ(single, odds[x]);
    }
  }
}

TEST(DenseNetwork, WhatIsNotKnownStaysSo) {
  const DenseNetwork network = random_network(1, {2, 3, 1});
  const float a[] = {1, std::nanf("")}, b[] = {2, 2};
  const float* inputs[] = {a, b};
  float odds[2];
  evaluate(network, inputs, odds);
  EXPECT_FALSE(std::isnan(odds[0]));
  EXPECT_TRUE(std::isnan(odds[1]));
}

TEST(DenseNetwork, TextComesBack) {
  const DenseNetwork network =
      parse_dense_network(as_text(random_network(2, {4, 6, 1}), "crowns"), "crowns", "a");
  EXPECT_EQ(parse_dense_network(as_text(network, "crowns"), "crowns", "b"), network);
  EXPECT_EQ(network.trained_on, "nothing");
}

TEST(DenseNetwork, DamagedTextIsRefused) {
  const std::string whole = as_text(random_network(3, {4, 6, 1}), "crowns");
  for (std::size_t length = 0; length + 8 < whole.size(); length += 11)
    EXPECT_THROW(parse_dense_network(std::string_view(whole).substr(0, length), "crowns", "model.txt"), Error)
        << length;
  try {
    parse_dense_network("dense_network 2\n", "crowns", "model.txt");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("model.txt"));
  }
}

/// Inside a ring or not: no single layer can tell.
NetworkExamples ring(std::uint64_t seed, std::size_t count) {
  Random random(seed, "ring");
  NetworkExamples examples{.inputs = 2, .values = {}, .targets = {}};
  for (std::size_t i = 0; i < count; ++i) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
    examples.values.push_back(static_cast<float>(x)), examples.values.push_back(static_cast<float>(y));
    examples.targets.push_back(std::hypot(x, y) > 0.4 && std::hypot(x, y) < 0.8 ? 1.0F : 0.0F);
  }
  return examples;
}

TEST(TrainNetwork, LearnsWhatIsNotLinear) {
  const NetworkTraining training{.hidden = {16, 8}, .rounds = 60, .batch_size = 64};
  const NetworkExamples examples = ring(1, 4000), others = ring(2, 500);
  const DenseNetwork network = train_network(examples, training);
  int right = 0;
  for (std::size_t i = 0; i < others.targets.size(); ++i) {
    const float* inputs[] = {&others.values[2 * i], &others.values[2 * i + 1]};
    float odds = 0;
    evaluate(network, inputs, {&odds, 1});
    right += (odds > 0) == (others.targets[i] > 0.5F);
  }
  EXPECT_GT(right, 460);
}

TEST(TrainNetwork, TheSameExamplesAndSeedGiveTheSameNetwork) {
  const NetworkExamples examples = ring(3, 500);
  const NetworkTraining training{.hidden = {5}, .rounds = 3};
  EXPECT_EQ(train_network(examples, training), train_network(examples, training));
  NetworkTraining other = training;
  other.seed = 2;
  EXPECT_NE(train_network(examples, other), train_network(examples, training));
}

}  // namespace
}  // namespace waymark::test
