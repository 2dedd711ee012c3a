// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/adjust.hpp"

#include <gtest/gtest.h>

namespace waymark::test {
namespace {
using namespace pipeline;

TEST(Adjust, NothingPosedIsAnError) {
  Reconstruction scene;
  EXPECT_ANY_THROW(adjust(scene, {}));
}

}  // namespace
}  // namespace waymark::test
