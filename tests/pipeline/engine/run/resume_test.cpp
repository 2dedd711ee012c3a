// SPDX-License-Identifier: Apache-2.0
// Runs with a work folder: no unit runs twice, no stale result is used.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <fstream>
#include <numeric>
#include <random>

#include "core/text_file.hpp"
#include "tests/pipeline/engine/toy_test.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

std::string text_of(const fs::path& file) {
  return read_text(file, "the result");
}

/// Returns the files below `folder` whose names end with `end`, sorted.
std::vector<fs::path> files_ending(const fs::path& folder, std::string_view end) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().string().ends_with(end)) found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

class ResumeTest : public ToyTest {
 protected:
  RunResult go(RunOptions options = {}) {
    options.work = work;
    return run(pipeline, options);
  }
  /// Runs once and resets the counts.
  void go_before() {
    go();
    ran();
  }
};

TEST_F(ResumeTest, TheSecondRunDoesNothing) {
  const RunResult first = go();
  EXPECT_THAT(ran(), ElementsAre(1, 4, 1));
  const RunResult second = go();
  EXPECT_THAT(ran(), ElementsAre(0, 0, 0));
  EXPECT_EQ(sum_of(second), sum_of(first));
  EXPECT_EQ(second.report.stages[1].reused, 4);
  EXPECT_EQ(second.report.stages[1].counts, first.report.stages[1].counts);
  EXPECT_TRUE(second.report.complete());
}

TEST_F(ResumeTest, AResultThatIsNotKeptIsMadeAgain) {
  toy::watch().in_square = [](StageContext& unit) {
    if (unit.tile().index == 1) unit.do_not_keep();
  };
  const RunResult first = go();
  EXPECT_TRUE(first.report.complete());
  ran();
  const RunResult second = go();
  EXPECT_EQ(sum_of(second), sum_of(first));
  EXPECT_THAT(ran(), ElementsAre(0, 1, 0));
}

TEST_F(ResumeTest, AChangedOptionReachesDownstreamOnly) {
  go_before();
  pipeline.set("sum_squares.sign=&");
  EXPECT_EQ(sum_of(go()), "9&16&25&36=86");
  EXPECT_THAT(ran(), ElementsAre(0, 0, 1));
  pipeline.set("square_number.power=1");
  EXPECT_EQ(sum_of(go()), "3&4&5&6=18");
  EXPECT_THAT(ran(), ElementsAre(0, 4, 1));
  pipeline.set("square_number.power=2").set("sum_squares.sign=+");
  EXPECT_EQ(sum_of(go()), "9+16+25+36=86");
  EXPECT_THAT(ran(), ElementsAre(0, 0, 0)) << "what was made before is still there";
}

TEST_F(ResumeTest, AnOptionWithoutEffectChangesNothing) {
  go_before();
  pipeline.set("square_number.memory=64");
  go();
  EXPECT_THAT(ran(), ElementsAre(0, 0, 0));
}

TEST_F(ResumeTest, MoreTilesAreMadeBesideThoseThatAreThere) {
  go_before();
  pipeline.set("list_numbers.tiles=6");
  go();
  EXPECT_THAT(ran(), ElementsAre(1, 6, 1))
      << "a tile reads the list's number, which has another fingerprint now";
}

TEST_F(ResumeTest, TheContentOfAnInputFileCounts) {
  const TemporaryFolder data;
  const std::string file = data / "dem.txt";
  std::ofstream(file) << "one";
  pipeline.set("list_numbers.files=" + file);
  go_before();
  fs::last_write_time(file, fs::file_time_type::clock::now() + std::chrono::hours(1));
  go();
  EXPECT_THAT(ran(), ElementsAre(0, 0, 0)) << "touched, but the same";
  std::ofstream(file) << "two";
  go();
  EXPECT_THAT(ran(), ElementsAre(1, 4, 1));
}

TEST_F(ResumeTest, RerunsFromAStageAndWhatReadsIt) {
  go_before();
  EXPECT_EQ(sum_of(go({.rerun_from = "square_number"})), "9+16+25+36=86");
  EXPECT_THAT(ran(), ElementsAre(0, 4, 1));
  go();
  EXPECT_THAT(ran(), ElementsAre(0, 0, 0));
}

TEST_F(ResumeTest, ASecondRunDoesOnlyWhatFailed) {
  toy::watch().in_square = [](const StageContext& unit) {
    if (unit.tile().index == 2) throw Error(ErrorCode::input, "the file is torn");
  };
  EXPECT_EQ(go().report.exit_code(), 3);
  const auto records = files_ending(work, ".failure.json");
  ASSERT_EQ(records.size(), 1U);
  EXPECT_EQ(records[0].parent_path(), work / "square_number/tile_000002");
  EXPECT_THAT(text_of(records[0]), HasSubstr("the file is torn"));
  ran();
  toy::watch().in_square = {};
  EXPECT_EQ(sum_of(go()), "9+16+25+36=86");
  EXPECT_THAT(ran(), ElementsAre(0, 1, 1));
  EXPECT_THAT(files_ending(work, ".failure.json"), testing::IsEmpty());
}

TEST_F(ResumeTest, DamagedResultsAreMadeAgain) {
  const auto truncate = [](const fs::path& file) { fs::resize_file(file, fs::file_size(file) / 2); };
  const auto flip_a_bit = [](const fs::path& file) {
    std::string bytes = text_of(file);
    bytes[bytes.size() / 2] ^= 1;
    std::ofstream(file, std::ios::binary) << bytes;
  };
  const auto remove = [](const fs::path& file) { fs::remove(file); };
  const auto empty = [](const fs::path& file) { std::ofstream{file}; };
  const auto other_json = [](const fs::path& file) { std::ofstream(file) << R"({"outputs": 3})"; };
  go_before();
  const fs::path payload = files_ending(work / "square_number/tile_000001", "square.bin").at(0);
  const fs::path manifest = files_ending(work / "square_number/tile_000001", "manifest.json").at(0);
  const std::vector<std::function<void()>> damages{[&] { truncate(payload); },   [&] { flip_a_bit(payload); },
                                                   [&] { remove(payload); },     [&] { empty(payload); },
                                                   [&] { truncate(manifest); },  [&] { remove(manifest); },
                                                   [&] { other_json(manifest); }};
  for (const auto& damage : damages) {
    damage();
    EXPECT_EQ(sum_of(go()), "9+16+25+36=86");
    EXPECT_THAT(ran(), ElementsAre(0, 1, 0)) << "the sum's own result is whole";
  }
  flip_a_bit(files_ending(work / "list_numbers", "tiles.bin").at(0));
  go();
  EXPECT_THAT(ran(), ElementsAre(1, 0, 0));
}

TEST_F(ResumeTest, AResultThatCannotBeReadBackNamesTheStageToRerun) {
  go_before();
  const fs::path result = files_ending(work / "square_number/tile_000001", "square.bin").at(0).parent_path();
  std::ofstream(result / "square.bin") << "many";  // complete, but with another layout
  const std::string manifest = text_of(result / "manifest.json");
  const std::size_t sum = manifest.find("\"square\": \"") + 11;
  std::ofstream(result / "manifest.json")
      << std::string(manifest).replace(sum, 64, hash_plain_file(result / "square.bin").sha256);
  fs::remove_all(work / "sum_squares");
  const RunResult again = go();
  ASSERT_EQ(again.report.failures.size(), 1U);
  EXPECT_THAT(again.report.failures[0].message, testing::StartsWith("cannot read a stored result: "));
  EXPECT_THAT(again.report.failures[0].message,
              HasSubstr("compute it again with --rerun-from square_number"));
  EXPECT_EQ(sum_of(go({.rerun_from = "square_number"})), "9+16+25+36=86");
}

TEST_F(ResumeTest, OneUnitAtATime) {
  EXPECT_EQ(message_of([&] { go({.unit = "sum_squares/map"}); }),
            "cannot do sum_squares/map: it reads square_number/tile_000000, which is not done\n  " +
                fs::path(work).string() + "\n  first do --unit square_number/tile_000000");
  ran();
  for (const Unit& unit : plan(pipeline, {.work = work}).units) go({.unit = unit.id()});
  EXPECT_THAT(ran(), ElementsAre(0, 4, 1));
  EXPECT_EQ(sum_of(go()), "9+16+25+36=86");
  EXPECT_THAT(ran(), ElementsAre(0, 0, 0));
}

RC_GTEST_FIXTURE_PROP(ResumeTest, SharesInAnyOrderFinishTheJob, ()) {
  const int count = *rc::gen::inRange(1, 7);
  std::vector<int> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), 1);
  std::shuffle(order.begin(), order.end(), std::mt19937(*rc::gen::arbitrary<unsigned>()));
  fs::remove_all(work);
  ran();
  for (const int index : order) {
    const RunResult share = go({.shard = Shard{index, count}});
    RC_ASSERT(share.report.exit_code() == 0);
    if (index == order.back()) RC_ASSERT(share.report.complete());
  }
  RC_ASSERT(ran() == std::vector({1, 4, 1}));
  RC_ASSERT(sum_of(go()) == "9+16+25+36=86");
  RC_ASSERT(ran() == std::vector({0, 0, 0}));
}

TEST_F(ResumeTest, AFolderThatCannotBeMadeSaysSo) {
  std::ofstream(work / "file") << "x";
  EXPECT_EQ(message_of([&] { run(pipeline, {.work = work / "file"}); }),
            "cannot create the work folder: Not a directory\n  " + (work / "file").string() +
                "\n  choose another folder with --work");
}

TEST_F(ResumeTest, AFullDiskStopsTheRun) {
  go_before();
  fs::remove_all(work / "square_number/tile_000003");
  std::ofstream(work / "square_number/tile_000003") << "no folder";
  pipeline.set("square_number.power=3");
  EXPECT_EQ(message_of([&] { go(); }), "cannot create the work folder: Not a directory\n  " +
                                           (work / "square_number/tile_000003").string() +
                                           "\n  choose another folder with --work");
}

}  // namespace
}  // namespace waymark::test
