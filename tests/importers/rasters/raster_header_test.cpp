// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/raster_header.hpp"

#include <gtest/gtest.h>

namespace waymark::test {
using namespace importers;
namespace {

TEST(HeightUnit, KnowsTheUsualNames) {
  EXPECT_EQ(height_unit("").metres, 1);
  EXPECT_EQ(height_unit("Metre").metres, 1);
  EXPECT_EQ(height_unit("ft").metres, 0.3048);
  EXPECT_EQ(height_unit("US survey foot").metres, 1200.0 / 3937);
  EXPECT_EQ(height_unit("KM").metres, 1000);
  EXPECT_EQ(height_unit("cm").metres, 0.01);
}

TEST(HeightUnit, ReportsUnknownUnits) {
  EXPECT_TRUE(height_unit("m").known);
  EXPECT_FALSE(height_unit("fathom").known);
}

}  // namespace
}  // namespace waymark::test
