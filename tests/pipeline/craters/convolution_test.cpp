// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/random.hpp"
#include "pipeline/craters/convolution_training.hpp"
#include "pipeline/craters/crater_model.hpp"
#include "pipeline/craters/patch_network_training.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

using ::testing::HasSubstr;

Convolution layer(int side, int channels, int scalars, int kernel, int stride, int outputs) {
  return {side, channels, scalars, kernel, stride, outputs, {}, {}};
}

// Layers of all kinds with random weights.
ConvolutionNet small_net(Random& random) {
  ConvolutionTrainer learner({layer(9, 1, 0, 3, 2, 8), layer(4, 8, 0, 3, 1, 16), layer(2, 16, 3, 2, 1, 32),
                              layer(1, 32, 0, 1, 1, 4)},
                             random);
  return learner.net();
}

std::vector<float> numbers(Random& random, std::size_t count) {
  std::vector<float> values(count);
  for (float& v : values) v = static_cast<float>(random.normal());
  return values;
}

// The slow twin: each sum by its definition, in double precision.
std::vector<double> by_definition(const ConvolutionNet& net, const std::vector<float>& image,
                                  const std::vector<float>& scalars) {
  std::vector<double> in(image.begin(), image.end()), out;
  for (const Convolution& c : net) {
    out.clear();
    for (int y = 0; y < c.out_side(); ++y)
      for (int x = 0; x < c.out_side(); ++x)
        for (int o = 0; o < c.outputs; ++o) {
          double sum = double(c.biases[static_cast<std::size_t>(o)]);
          const auto weight = [&](int input) {
            return double(c.weights[static_cast<std::size_t>(input * c.outputs + o)]);
          };
          for (int j = 0; j < c.kernel; ++j)
            for (int i = 0; i < c.kernel; ++i)
              for (int k = 0; k < c.channels; ++k) {
                const int row = y * c.stride + j, column = x * c.stride + i;
                sum += weight((j * c.kernel + i) * c.channels + k) *
                       in[static_cast<std::size_t>((row * c.side + column) * c.channels + k)];
              }
          for (int f = 0; f < c.scalars; ++f)
            sum +=
                weight(c.kernel * c.kernel * c.channels + f) * double(scalars[static_cast<std::size_t>(f)]);
          out.push_back(&c == &net.back() || sum > 0 ? sum : 0.1 * sum);
        }
    in = out;
  }
  return in;
}

TEST(ConvolutionNet, AnswersAsByDefinition) {
  Random random(11, "convolution test");
  const ConvolutionNet net = small_net(random);
  const auto image = numbers(random, 81), scalars = numbers(random, 3);
  const auto fast = evaluate(net, image, scalars);
  const auto slow = by_definition(net, image, scalars);
  ASSERT_EQ(fast.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(fast[i], slow[i], 1e-4);
}

// Positions are summed several at a time if their number permits, as in the shipped network.
TEST(ConvolutionNet, SeveralPlacesAtATimeKeepTheBits) {
  Random random(15, "convolution test");
  const ConvolutionNet& net = built_in_crater_model().convolution_nets.at(0);
  std::vector<float> in = numbers(random, 24 * 24);
  const auto scalars = numbers(random, 3);
  for (const Convolution& c : net) {
    const bool last = &c == &net.back();
    std::vector<float> fast, slow;
    convolve(c, in, scalars, last, fast);
    for (int y = 0; y < c.out_side(); ++y)
      for (int x = 0; x < c.out_side(); ++x)
        for (int o = 0; o < c.outputs; ++o) {
          float sum = c.biases[static_cast<std::size_t>(o)];
          const float* weight = c.weights.data() + o;
          const int row = c.kernel * c.channels;
          for (int i = 0; i < c.kernel * row; ++i, weight += c.outputs) {
            const int from = ((y * c.stride + i / row) * c.side + x * c.stride) * c.channels + i % row;
            sum += in[static_cast<std::size_t>(from)] * *weight;
          }
          for (int i = 0; i < c.scalars; ++i, weight += c.outputs)
            sum += scalars[static_cast<std::size_t>(i)] * *weight;
          slow.push_back(last || sum > 0 ? sum : 0.1F * sum);
        }
    EXPECT_EQ(fast, slow);
    in = fast;
  }
}

// One step of Adam moves each weight against the sign of its slope: the loss must fall, and the slopes must
// be those of finite differences.
TEST(ConvolutionTrainer, ReducesTheLoss) {
  Random random(12, "convolution test");
  ConvolutionTrainer learner({layer(9, 1, 0, 3, 2, 8), layer(4, 8, 0, 4, 1, 4)}, random);
  const auto image = numbers(random, 81);
  const std::vector<float> wanted{1, -2, 0.5F, 3};
  const auto loss = [&] {
    const auto out = learner.forward(image, {});
    double sum = 0;
    std::vector<float> slopes;
    for (std::size_t i = 0; i < 4; ++i) {
      const float off = out[i] - wanted[i];
      sum += 0.5 * double(off) * double(off), slopes.push_back(off);
    }
    learner.backward(slopes);
    return sum;
  };
  const double before = loss();
  learner.step(0.01, 0, 1);
  for (int i = 0; i < 200; ++i) loss(), learner.step(0.01, 0, 1);
  EXPECT_LT(loss(), 1e-3 * before);
}

TEST(ConvolutionTrainer, FirstStepGoesDownEverySlope) {
  // Adam's first step is rate x sign(slope): finite differences must have that sign.
  Random random(13, "convolution test");
  const ConvolutionNet start = small_net(random);
  Random again(13, "convolution test");
  ConvolutionTrainer learner({layer(9, 1, 0, 3, 2, 8), layer(4, 8, 0, 3, 1, 16), layer(2, 16, 3, 2, 1, 32),
                              layer(1, 32, 0, 1, 1, 4)},
                             again);
  Random data(14, "convolution test");
  const auto image = numbers(data, 81), scalars = numbers(data, 3);
  const std::vector<float> slopes{1, -0.5F, 0.25F, 2};
  learner.forward(image, scalars);
  learner.backward(slopes);
  learner.step(1e-3, 0, 1);
  const auto loss = [&](const ConvolutionNet& net) {
    const auto out = by_definition(net, image, scalars);
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) sum += double(slopes[i]) * out[i];
    return sum;
  };
  int compared = 0;
  for (std::size_t l = 0; l < start.size(); ++l)
    for (std::size_t i = 0; i < start[l].weights.size(); i += 37) {
      ConvolutionNet up = start, down = start;
      up[l].weights[i] += 1e-3F, down[l].weights[i] -= 1e-3F;
      const double slope = (loss(up) - loss(down)) / 2e-3;
      if (std::abs(slope) < 1e-3) continue;  // its sign is rounding's
      const double moved = double(learner.net()[l].weights[i]) - double(start[l].weights[i]);
      EXPECT_NEAR(moved, slope > 0 ? -1e-3 : 1e-3, 1e-5) << "layer " << l << ", weight " << i;
      ++compared;
    }
  EXPECT_GT(compared, 50);
}

TEST(CraterModel, TextKeepsConvolutions) {
  const CraterModel& model = built_in_crater_model();
  ASSERT_FALSE(model.convolution_nets.empty());
  const CraterModel again = parse_crater_model(as_text(model), "test");
  WidePatch wide;
  for (std::size_t i = 0; i < wide.patch.size(); ++i) wide.patch[i] = static_cast<float>(std::sin(double(i)));
  const CraterPrediction a = predict(model.convolution_nets, wide), b = predict(again.convolution_nets, wide);
  EXPECT_NEAR(a.probability, b.probability, 1e-3);
  EXPECT_NEAR(a.log_size, b.log_size, 1e-3);
}

TEST(CraterModel, SaysWhatIsWrongWithAConvolution) {
  const auto message = [](const std::string& line) {
    const std::string text = as_text(built_in_crater_model());
    const auto at = text.find("convolution");
    try {
      parse_crater_model(text.substr(0, at) + line + '\n', "m.txt");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_THAT(message("convolution 23 1 0 5 2 8"),
              HasSubstr("a convolution of 23 x 23 x 1 follows 24 x 24 x 1"));
  EXPECT_THAT(message("convolution 24 1 0 25 2 8"), HasSubstr("a kernel is 1 to SIDE wide"));
  EXPECT_THAT(message("convolution 24 1 3 5 2 8"), HasSubstr("3 facts go into a convolution as wide as"));
  EXPECT_THAT(message("convolution 24 1 0 5 2 7"), HasSubstr("4, 8, 16 or 32 outputs"));
  EXPECT_THAT(message("convolution 24 1 0"), HasSubstr("a number is missing"));
  EXPECT_THAT(message("layer 4 4"), HasSubstr("m.txt, line"));
}

TEST(AugmentImage, SameForTheSameSeedAndNothingMoves) {
  const LabelledScene scene = shaded_scene(9100, 128);
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    Pixels image = scene.image, again = scene.image;
    augment_image(image, seed), augment_image(again, seed);
    EXPECT_TRUE(std::ranges::equal(image.cells(), again.cells()));
    double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    for (std::size_t i = 0; i < image.cells().size(); ++i) {
      const double p = double(scene.image.cells()[i]), q = double(image.cells()[i]);
      ASSERT_TRUE(std::isfinite(q));
      ++n, a += p, b += q, aa += p * p, bb += q * q, ab += p * q;
    }
    EXPECT_GT((ab - a * b / n) / std::sqrt((aa - a * a / n) * (bb - b * b / n)), 0.6) << seed;
  }
}

}  // namespace
}  // namespace waymark::test
