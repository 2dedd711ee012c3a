// SPDX-License-Identifier: Apache-2.0
#include "importers/cameras/altimeter_table.hpp"

#include <gmock/gmock.h>

#include "tests/importers/raster_maker.hpp"

namespace waymark::test {
using namespace importers;
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::vector<AltimeterReading> altimeter(const std::string& text) {
  return read_altimeter_table(write_text("altimeter.csv", text));
}
std::string altimeter_refusal(const std::string& text) {
  return message_of([&] { altimeter(text); });
}

TEST(AltimeterTable, ReadsHeightsOfEitherKind) {
  const auto readings = altimeter("image,above_ground,height,sd\na.jpg,120.5,,0.5\nb.jpg,,431,\n");
  ASSERT_EQ(readings.size(), 2u);
  EXPECT_EQ(readings[0].image, "a.jpg");
  EXPECT_EQ(readings[0].above_ground, 120.5);
  EXPECT_EQ(readings[0].sd, 0.5);
  EXPECT_FALSE(readings[0].height);
  EXPECT_EQ(readings[1].height, 431);
  EXPECT_FALSE(readings[1].above_ground);
  EXPECT_FALSE(readings[1].sd);
}

TEST(AltimeterTable, SaysWhatIsWrongAndWhere) {
  EXPECT_THAT(altimeter_refusal("image,depth\na.jpg,3\n"),
              AllOf(HasSubstr("no column 'above_ground'"), HasSubstr("it has: image, depth")));
  EXPECT_THAT(altimeter_refusal("height\n3\n"), HasSubstr("no column 'image'"));
  EXPECT_THAT(altimeter_refusal("image,above_ground\na.jpg,high\n"),
              AllOf(HasSubstr("'high' is not a number"), HasSubstr("line 2"), HasSubstr("above_ground")));
  EXPECT_THAT(altimeter_refusal("image,above_ground\na.jpg,-4\n"), HasSubstr("height above ground -4"));
  EXPECT_THAT(altimeter_refusal("image,above_ground\na.jpg,4\na.jpg,5\n"),
              AllOf(HasSubstr("two rows are of the image 'a.jpg'"), HasSubstr("line 3")));
  EXPECT_THAT(altimeter_refusal("image,height,sd\na.jpg,4,0\n"), HasSubstr("deviation 0 is not above 0"));
  EXPECT_THAT(altimeter_refusal("image,height\n"), HasSubstr("there are no readings"));
}

}  // namespace
}  // namespace waymark::test
