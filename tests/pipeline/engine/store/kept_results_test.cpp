// SPDX-License-Identifier: Apache-2.0
// Results of steps in a work folder: nothing is computed twice, nothing stale is used.
#include "pipeline/engine/store/kept_results.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <thread>

#include "core/error.hpp"

namespace waymark::test {
struct KeptText {
  std::string text;
};
}  // namespace waymark::test

namespace waymark::pipeline {
template <>
struct Codec<test::KeptText> {
  static std::string encode(const test::KeptText& value) { return value.text; }
  static test::KeptText decode(std::string_view bytes) { return {std::string(bytes)}; }
};
}  // namespace waymark::pipeline

namespace waymark::test {
using namespace pipeline;
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

class KeptResultsTest : public testing::Test {
 protected:
  KeptResultsTest()
      : folder_(fs::path(testing::TempDir()) /
                ("kept_" + std::to_string(::getpid()) +
                 testing::UnitTest::GetInstance()->current_test_info()->name())) {}
  ~KeptResultsTest() override { fs::remove_all(folder_); }

  std::string get(const KeptStep& step, const std::string& made) {
    return KeptResults(folder_)
        .get<KeptText>(step,
                       [&] {
                         ++computed_;
                         return KeptText{made};
                       })
        .text;
  }

  fs::path folder_;
  std::atomic<int> computed_ = 0;
};

TEST_F(KeptResultsTest, AreComputedOnce) {
  const KeptStep step{.name = "step", .item = "all", .version = 1, .depends_on = "x"};
  EXPECT_EQ(get(step, "a"), "a");
  EXPECT_EQ(get(step, "b"), "a");
  EXPECT_EQ(computed_, 1);
}

TEST_F(KeptResultsTest, WhateverDeterminesThemMakesNewOnes) {
  const KeptStep step{.name = "step", .item = "all", .version = 1, .depends_on = "x"};
  KeptStep version = step, input = step, item = step, name = step;
  version.version = 2, input.depends_on = "y", item.item = "folder/image.png", name.name = "other";
  for (const KeptStep& other : {step, version, input, item, name})
    EXPECT_EQ(get(other, other.fingerprint()), other.fingerprint());
  EXPECT_EQ(computed_, 5);
  EXPECT_EQ(get(item, ""), item.fingerprint());
}

TEST_F(KeptResultsTest, DamagedOnesAreComputedAgain) {
  const KeptStep step{.name = "step", .item = "all", .version = 1, .depends_on = "x"};
  get(step, "right");
  for (const auto& entry : fs::recursive_directory_iterator(folder_))
    if (entry.path().extension() == ".bin") std::ofstream(entry.path()) << "wrong";
  EXPECT_EQ(get(step, "right"), "right");
  EXPECT_EQ(computed_, 2);
}

TEST_F(KeptResultsTest, WarningsAreKept) {
  const KeptStep step{.name = "step", .item = "all", .version = 1, .depends_on = "x"};
  for (int i = 0; i < 2; ++i) {
    std::vector<std::string> warnings{"before"};
    KeptResults(folder_).get<KeptText>(
        step,
        [&](std::vector<std::string>& said) {
          ++computed_;
          said.push_back("dark");
          return KeptText{"a"};
        },
        warnings);
    EXPECT_THAT(warnings, ElementsAre("before", "dark"));
  }
  EXPECT_EQ(computed_, 1);
}

TEST_F(KeptResultsTest, WithoutAFolderNothingIsKept) {
  const KeptResults none("");
  EXPECT_FALSE(none.enabled());
  for (int i = 0; i < 2; ++i)
    none.get<KeptText>({.name = "step", .item = "all", .version = 1, .depends_on = ""}, [&] {
      ++computed_;
      return KeptText{};
    });
  EXPECT_EQ(computed_, 2);
}

TEST_F(KeptResultsTest, AFailureLeavesNothing) {
  const KeptStep step{.name = "step", .item = "all", .version = 1, .depends_on = "x"};
  const KeptResults kept(folder_);
  EXPECT_THROW(kept.get<KeptText>(step, []() -> KeptText { throw Error(ErrorCode::input, "bad", "", ""); }),
               Error);
  EXPECT_EQ(get(step, "good"), "good");
}

TEST_F(KeptResultsTest, ManyThreadsMayAskForOneItem) {
  const KeptResults kept(folder_);
  std::vector<std::thread> threads;
  std::atomic<int> right = 0;
  for (int t = 0; t < 8; ++t)
    threads.emplace_back([&] {
      for (int i = 0; i < 20; ++i) {
        const std::string text = std::to_string(i);
        right += kept.get<KeptText>({.name = "step", .item = text, .version = 1, .depends_on = ""},
                                    [&] { return KeptText{text}; })
                     .text == text;
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(right, 160);
}

}  // namespace
}  // namespace waymark::test
