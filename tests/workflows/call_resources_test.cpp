// SPDX-License-Identifier: Apache-2.0
#include "workflows/call_resources.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"

namespace waymark::test {
using namespace workflows;
namespace {

using testing::HasSubstr;
const std::vector<std::string> kStages{"list_tiles", "join"};

std::map<std::string, pipeline::CallResources> parse(const std::vector<std::string>& texts) {
  return parse_resources(texts, kStages);
}

std::string message_of_texts(const std::vector<std::string>& texts) {
  try {
    parse(texts);
  } catch (const Error& e) {
    return std::string(e.code() == ErrorCode::usage ? "usage: " : "other: ") + e.what();
  }
  return "none";
}

TEST(CallResources, StagesInheritWhatTheyDoNotName) {
  const auto all = parse({"join:memory=16G", "cpus=2,memory=2500M,time=90", "map:time=2h"});
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all.at("").processors, 2);
  EXPECT_EQ(all.at("").megabytes, 2500);
  EXPECT_EQ(all.at("").minutes, 90);
  EXPECT_EQ(all.at("join").processors, 2);
  EXPECT_EQ(all.at("join").megabytes, 16000);
  EXPECT_EQ(all.at("join").minutes, 90);
  EXPECT_EQ(all.at("map").minutes, 120);
  EXPECT_TRUE(parse({}).empty());
}

TEST(CallResources, WordsReplaceWhatWasMeasured) {
  const std::map<std::string, pipeline::CallResources> measured{{"join", {2, 700, 5}}, {"map", {1, 300, 2}}};
  const auto parse_all = [&](const std::vector<std::string>& texts) {
    return parse_resources(texts, kStages, measured);
  };
  EXPECT_EQ(parse_all({}).at("join").megabytes, 700);
  const auto all = parse_all({"time=60", "join:memory=2G"});
  EXPECT_EQ(all.at("join").megabytes, 2000);
  EXPECT_EQ(all.at("join").processors, 2);
  EXPECT_EQ(all.at("join").minutes, 60);
  EXPECT_EQ(all.at("map").megabytes, 300);
  EXPECT_EQ(all.at("map").minutes, 60);
  EXPECT_EQ(all.at("").minutes, 60);
}

TEST(CallResources, NonsenseIsRefused) {
  EXPECT_THAT(message_of_texts({"memory=8"}), HasSubstr("usage: memory=8 has no unit"));
  EXPECT_THAT(message_of_texts({"memory=-8G"}), HasSubstr("is no amount"));
  EXPECT_THAT(message_of_texts({"cpus=0"}), HasSubstr("is no amount"));
  EXPECT_THAT(message_of_texts({"cpus=two"}), HasSubstr("cpus must be a whole number"));
  EXPECT_THAT(message_of_texts({"cpus"}), HasSubstr("cpus must be a whole number"));
  EXPECT_THAT(message_of_texts({"time=99999999999999h"}), HasSubstr("time"));
  EXPECT_THAT(message_of_texts({"disk=8G"}), HasSubstr("'disk' is no resource"));
  EXPECT_THAT(message_of_texts({"merge:cpus=1"}),
              HasSubstr("no stage 'merge'; it has list_tiles, join, map"));
  EXPECT_THAT(message_of_texts({"join:cpus=1", "join:cpus=2"}), HasSubstr("'join' is given twice"));
  EXPECT_THAT(message_of_texts({"cpus=1", "cpus=2"}), HasSubstr("all calls are given twice"));
}

}  // namespace
}  // namespace waymark::test
