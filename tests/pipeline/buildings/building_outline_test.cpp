// SPDX-License-Identifier: Apache-2.0
#include "pipeline/buildings/building_outline.hpp"

#include <gmock/gmock.h>

namespace waymark::test {
using namespace pipeline;
namespace {

using List = std::vector<BuildingOutline>;

TEST(BuildingOutlines, AreTheSameAfterEncodingAndDecoding) {
  const List made{{.uid = "a",
                   .source = "s.las",
                   .roof = "flat",
                   .outline = "regular",
                   .rings = {{{0, 0}, {4, 0}, {4, 3}}, {{1, 1}, {1, 2}, {2, 1}}},
                   .height = 5,
                   .area = 6,
                   .slope = 0.1,
                   .wall_sd = 0.2,
                   .density = 7,
                   .confidence = 0.5},
                  {}};
  const std::string bytes = Codec<List>::encode(made);
  const List read = Codec<List>::decode(bytes);
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].rings, made[0].rings);
  EXPECT_EQ(read[0].uid, "a");
  EXPECT_EQ(read[0].confidence, 0.5);
  EXPECT_EQ(Codec<List>::encode(read), bytes);
  EXPECT_THROW(Codec<List>::decode(bytes.substr(0, bytes.size() - 4)), std::runtime_error);
}

}  // namespace
}  // namespace waymark::test
