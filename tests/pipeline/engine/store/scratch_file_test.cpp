// SPDX-License-Identifier: Apache-2.0
// Tile results that no map-scope stage reads stay out of memory, with and without a work folder.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>

#include <algorithm>
#include <atomic>

#include "pipeline/engine/store/scratch_file.hpp"
#include "tests/pipeline/engine/toy_test.hpp"

namespace waymark::test {
using namespace pipeline;

/// Counts its instances in memory, now and at most.
struct Heavy {
  explicit Heavy(std::int64_t n = 0) : number(n) { born(); }
  Heavy(const Heavy& other) : number(other.number) { born(); }
  Heavy& operator=(const Heavy&) = default;
  ~Heavy() { --living; }
  static void born() {
    const int now = ++living;
    for (int before = most; before < now && !most.compare_exchange_weak(before, now);) continue;
  }
  std::int64_t number = 0;
  static inline std::atomic<int> living = 0, most = 0;
};
}  // namespace waymark::test

namespace waymark::pipeline {

template <>
struct Codec<test::Heavy> {
  static std::string encode(const test::Heavy& heavy) {
    return std::to_string(heavy.number) + std::string(1000, ' ');
  }
  static test::Heavy decode(std::string_view text) { return test::Heavy(std::stoll(std::string(text))); }
};

}  // namespace waymark::pipeline

namespace waymark::test {
using namespace pipeline;

namespace {

constexpr std::int64_t kTileCount = 200;

struct NoScratchOptions {
  void describe(OptionVisitor&) {}
};

struct MakeHeavy {
  using Options = NoScratchOptions;
  static constexpr In<Number> number{"number"};
  static constexpr Out<Heavy> heavy{"heavy"};
  static StageSpec spec() {
    return {.name = "make_heavy",
            .summary = "Makes",
            .scope = Scope::tile,
            .inputs = {number},
            .outputs = {heavy}};
  }
  static void run(const Options&, StageContext& unit) {
    unit.write(heavy, Heavy(unit.read(number).value + unit.tile().index));
  }
};

struct DoubleHeavy {
  using Options = NoScratchOptions;
  static constexpr In<Heavy> heavy{"heavy"};
  static constexpr Out<Heavy> doubled{"doubled"};
  static StageSpec spec() {
    return {.name = "double_heavy",
            .summary = "Doubles",
            .scope = Scope::tile,
            .inputs = {heavy},
            .outputs = {doubled}};
  }
  static void run(const Options&, StageContext& unit) {
    unit.write(doubled, Heavy(2 * unit.read(heavy).number));
  }
};

class AsideTest : public testing::Test {
 protected:
  AsideTest() {
    registry.add<toy::ListNumbers>();
    registry.add<MakeHeavy>();
    registry.add<DoubleHeavy>();
    pipeline.add("list_numbers").add("make_heavy").add("double_heavy");
    pipeline.set("list_numbers.tiles=" + std::to_string(kTileCount));
    Heavy::most = 0;
  }
  static void expect_doubled(RunResult result) {
    const auto readers = result.take_readers<Heavy>("doubled");
    ASSERT_EQ(readers.size(), kTileCount);
    for (int again = 0; again < 2; ++again)
      for (std::size_t i = 0; i < readers.size(); ++i)
        ASSERT_EQ(readers[i]()->number, 2 * (3 + static_cast<std::int64_t>(i)));
    EXPECT_TRUE(result.take<Heavy>("doubled").empty());
  }
  Registry registry;
  Pipeline pipeline{registry};
  TemporaryFolder folder;
};

TEST_F(AsideTest, FewResultsOfTilesAreInMemory) {
  for (const std::size_t held : {std::size_t{0}, std::size_t{50'000}, std::size_t{1} << 30}) {
    expect_doubled(run(pipeline, {.threads = 2, .scratch = folder, .max_bytes_in_memory = held}));
    EXPECT_EQ(Heavy::living, 0);
    EXPECT_LE(Heavy::most, 8) << "a few for each of two threads, of " << kTileCount;
  }
}

TEST_F(AsideTest, AWorkFolderHoldsThem) {
  const RunOptions options{.work = folder, .threads = 2, .scratch = "/nowhere", .max_bytes_in_memory = 0};
  expect_doubled(run(pipeline, options));
  RunResult again = run(pipeline, options);
  EXPECT_EQ(again.report.stages[2].reused, kTileCount);
  expect_doubled(std::move(again));
  EXPECT_LE(Heavy::most, 8);
}

TEST_F(AsideTest, NothingIsSeenOfThemInTheFolder) {
  const RunResult result = run(pipeline, {.scratch = folder, .max_bytes_in_memory = 0});
  EXPECT_TRUE(std::filesystem::is_empty(static_cast<const std::filesystem::path&>(folder)));
}

TEST_F(AsideTest, ReportsWhetherEveryTileWasMade) {
  const RunResult result = run(pipeline, {.scratch = folder});
  EXPECT_TRUE(result.is_complete("double_heavy", "doubled"));
  EXPECT_FALSE(result.is_complete("double_heavy", "heavy"));
}

TEST_F(AsideTest, AFullDiskIsReported) {
  if (::mount("tmpfs", static_cast<const std::filesystem::path&>(folder).c_str(), "tmpfs", 0, "size=100k") !=
      0)
    GTEST_SKIP() << "a small tmpfs can only be mounted by root";
  const std::string message =
      message_of([&] { run(pipeline, {.scratch = folder, .max_bytes_in_memory = 0}); });
  ::umount2(static_cast<const std::filesystem::path&>(folder).c_str(), MNT_DETACH);
  EXPECT_THAT(message, testing::HasSubstr("the disk is full"));
  EXPECT_THAT(message, testing::HasSubstr("free some space"));
}

TEST_F(AsideTest, AFolderThatIsMissingIsNamed) {
  const std::string message =
      message_of([&] { run(pipeline, {.scratch = "/nowhere", .max_bytes_in_memory = 0}); });
  EXPECT_THAT(message, testing::HasSubstr("/nowhere"));
}

TEST(ScratchFile, GivesBackWhatItTook) {
  const TemporaryFolder folder;
  ScratchFile file(folder, 10);
  std::vector<std::function<std::string()>> pieces;
  for (const std::size_t size : {4, 6, 0, 1, 100'000, 3})
    pieces.push_back(file.put(std::string(size, static_cast<char>('a' + pieces.size()))));
  EXPECT_EQ(pieces[0](), "aaaa");
  EXPECT_EQ(pieces[1](), "bbbbbb");
  EXPECT_EQ(pieces[2](), "");
  EXPECT_EQ(pieces[3](), "d");
  EXPECT_EQ(pieces[4](), std::string(100'000, 'e'));
  EXPECT_EQ(pieces[5](), "fff");
  EXPECT_EQ(pieces[4]().size(), 100'000u);
}

}  // namespace
}  // namespace waymark::test
