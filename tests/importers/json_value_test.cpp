// SPDX-License-Identifier: Apache-2.0
#include "importers/json_value.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"

namespace waymark::test {
namespace {

TEST(VsiText, OfADeviceWithoutEndIsRefused) {
  EXPECT_EQ(importers::read_vsi_text("/dev/null"), "");
  try {
    importers::read_vsi_text("/dev/zero");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::input);
    EXPECT_EQ(error.problem(), "cannot read the file: the device does not end");
    EXPECT_EQ(error.where(), "/dev/zero");
  }
}

}  // namespace
}  // namespace waymark::test
