// SPDX-License-Identifier: Apache-2.0
#include "pipeline/terrain/codecs.hpp"

#include <gtest/gtest.h>

#include "pipeline/fusion/association/landmark_codec.hpp"
#include "tests/pipeline/terrain/survey.hpp"
#include "tests/support/round_trip.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

const MemoryDem kDem(random_terrain(4, 50, 40), {}, NodataPolicy::unknown);

TEST(Codecs, DivideTree) {
  expect_round_trip(*tree_of(kDem, {16, 0, 20, 40}, 5), 97);
}

TEST(Codecs, BlockReliefAndPyramid) {
  const Window all{0, 0, 50, 40};
  const auto relief = block_relief(kDem.read({-1, -1, 52, 42}), all, kNoHeight);
  expect_round_trip(relief, 97);
  const std::shared_ptr<const BlockRelief> tiles[] = {std::make_shared<const BlockRelief>(relief)};
  expect_round_trip(ReliefPyramid(tiles, 50, 40), 97);
}

TEST(Codecs, Summits) {
  expect_round_trip(survey(kDem, 64), 97);
}

TEST(Codecs, Isolations) {
  expect_round_trip(std::vector<Isolation>{{{}, {}, {}}, {12.5, 7.0, {3, 4}}, {{}, 7.0, {}}}, 97);
}

TEST(Codecs, Landmarks) {
  Landmark l;
  l.uid = "mt-1";
  l.type = 2;
  l.position = {{1, 2, 3}};
  l.covariance(0, 1) = 0.5;
  l.features = {{1, 2, 3}, {}};
  l.attributes = {AttributeValue{}, 2.5, std::int64_t{7}, std::string("text")};
  l.quality = {2, 3, {0.5, std::nullopt}};
  expect_round_trip(std::vector<Landmark>{l, Landmark{}}, 97);
}

}  // namespace
}  // namespace waymark::test
