// SPDX-License-Identifier: Apache-2.0
#include "importers/rules/import_rules.hpp"

#include <gmock/gmock.h>

#include "tests/importers/raster_maker.hpp"

namespace waymark::test {
using namespace importers;
namespace {

std::string refusal_of_rules(const std::string& entry) {
  const std::string file =
      write_text("rules.json", R"({"waymark_rules": 1, "rules": [{"type": "pole", )" + entry + "}]}");
  return message_of([&] { read_import_rules(file); });
}

TEST(ImportRules, LengthsAndTurnsHaveRanges) {
  EXPECT_THAT(refusal_of_rules(R"("min_length": -1)"),
              testing::HasSubstr("min_length = -1 is outside [0, 1000000] m"));
  EXPECT_THAT(refusal_of_rules(R"("min_turn_deg": 175)"),
              testing::HasSubstr("min_turn_deg = 175 is outside [0, 170] deg"));
}

}  // namespace
}  // namespace waymark::test
