// SPDX-License-Identifier: Apache-2.0
#include "localization/frame_errors.hpp"

#include <gtest/gtest.h>

namespace waymark::test {
namespace {

using localization::FrameErrors;

TEST(FrameErrors, AMapThatStatesNothingHasNone) {
  EXPECT_FALSE(FrameErrors{}.any());
}

TEST(FrameErrors, AStatedAccuracyIsDividedBySightings) {
  FrameErrors survey;
  survey.survey_sd = 0.2;
  EXPECT_TRUE(survey.any());
  EXPECT_TRUE(survey.shift_is_learnt());
}

TEST(FrameErrors, AShiftThatIsSetIsNotDecidedBySightings) {
  FrameErrors none, set;
  none.survey_sd = set.survey_sd = 0.2;
  none.map_shift_sd = 0, set.map_shift_sd = 0.4;
  EXPECT_FALSE(none.any());
  EXPECT_TRUE(set.any());
  EXPECT_FALSE(set.shift_is_learnt());
}

}  // namespace
}  // namespace waymark::test
