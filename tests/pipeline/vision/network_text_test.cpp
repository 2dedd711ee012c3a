// SPDX-License-Identifier: Apache-2.0
#include "pipeline/vision/network_text.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "tests/support/message_of.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

using ::testing::HasSubstr;

StoredNetwork small_network() {
  StoredNetwork network;
  network.kind = "rocks";
  network.trained_on = "two examples";
  network.prior = 0.25;
  network.centre = {1, -2}, network.scale = {0.5, 3};
  network.layers = {{{2, 3}, {0.1, 0.2, 0.3}, {1, 2, 3, 4, 5, -6}}, {{3, 1}, {7}, {0.5, 0.25, -0.125}}};
  return network;
}

std::string problem_with(const std::string& text, const std::string& kind = "rocks") {
  return message_of([&] { parse_network(text, kind, "model.txt", dense_layers_of(2)); });
}

TEST(NetworkText, IsLinesThatPeopleCanRead) {
  EXPECT_THAT(network_as_text(small_network(), {.digits = 4}),
              ::testing::StartsWith(R"(waymark network 2 rocks
two examples
numbers decimal
prior 0.25
inputs 2
1 -2
0.5 3
layer 2 3
0.1 1 2
0.2 3 4
0.3 5 -6
layer 3 1
7 0.5 0.25 -0.125
check )"));
}

TEST(NetworkText, ComesBack) {
  const StoredNetwork network = small_network();
  for (const int digits : {0, 4}) {  // 0: packed, to a part in 64000 of the largest weight of an output
    const StoredNetwork again = parse_network(network_as_text(network, {.digits = digits}), "rocks", "a");
    EXPECT_EQ(again.trained_on, network.trained_on);
    EXPECT_EQ(again.prior, network.prior);
    EXPECT_EQ(again.centre, network.centre);
    EXPECT_EQ(again.scale, network.scale);
    ASSERT_EQ(again.layers.size(), 2U);
    for (std::size_t l = 0; l < 2; ++l) {
      EXPECT_EQ(again.layers[l].shape, network.layers[l].shape);
      for (std::size_t i = 0; i < network.layers[l].weights.size(); ++i)
        EXPECT_NEAR(again.layers[l].weights[i], network.layers[l].weights[i], digits ? 0 : 1e-4);
    }
  }
}

TEST(NetworkText, RefusesAnyChangeOfOneLetter) {
  const std::string text = network_as_text(small_network(), {.digits = 4});
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string changed = text;
    changed[i] = changed[i] == '1' ? '2' : '1';
    EXPECT_NE(problem_with(changed), "none") << i;
  }
  for (std::size_t length = 0; length + 1 < text.size(); ++length)
    EXPECT_NE(problem_with(text.substr(0, length)), "none") << length;
}

TEST(NetworkText, SaysWhatIsWrongAndWhere) {
  const std::string text = network_as_text(small_network(), {.digits = 4});
  EXPECT_THAT(problem_with("hello"), HasSubstr("this is no model of rocks: it does not begin with"));
  EXPECT_THAT(problem_with(text, "craters"), HasSubstr("this is no model of craters: it is one of rocks"));
  EXPECT_THAT(problem_with(text, "craters"), HasSubstr("model.txt, line 1"));
  EXPECT_THAT(problem_with(text, "craters"), HasSubstr("waymark train craters"));
  StoredNetwork wide = small_network();
  wide.layers[1].shape[0] = 2, wide.layers[1].weights.pop_back();
  EXPECT_THAT(problem_with(network_as_text(wide, {})), HasSubstr("a layer of 2 inputs follows 3 outputs"));
  EXPECT_THAT(problem_with(text.substr(0, text.find("check"))), HasSubstr("the file ends too early"));
}

TEST(NetworkText, ReadsVersion1) {
  const StoredNetwork crowns = parse_network(
      "dense_network 1\nlong ago\n2 2\n1 -2\n0.5 3\n2\n1 2 3 4\n0.1 0.2\n1\n5 6\n7\n", "crowns", "a");
  EXPECT_EQ(crowns.trained_on, "long ago");
  EXPECT_EQ(crowns.scale, (std::vector<double>{0.5, 3}));
  ASSERT_EQ(crowns.layers.size(), 2U);
  EXPECT_EQ(crowns.layers[0].weights, (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(crowns.layers[0].biases, (std::vector<double>{0.1, 0.2}));
  EXPECT_EQ(crowns.layers[1].shape, (std::vector<int>{2, 1}));
  // Digits of 0, 32000 and -32000 in the base of 64.
  const StoredNetwork craters =
      parse_network("waymark crater model 1\nlong ago\nlayer 3 1\n0.5 2 IAAP0AAMA\n", "craters", "a");
  ASSERT_EQ(craters.layers.size(), 1U);
  EXPECT_EQ(craters.layers[0].biases, std::vector<double>{0.5});
  EXPECT_EQ(craters.layers[0].weights, (std::vector<double>{0, 2, -2}));
}

}  // namespace
}  // namespace waymark::test
