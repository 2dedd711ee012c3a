// SPDX-License-Identifier: Apache-2.0
// Runs in memory: results, threads, failures, progress.
#include <cmath>
#include <condition_variable>
#include <fstream>
#include <set>
#include <thread>

#include "tests/pipeline/engine/toy_test.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class RunTest : public ToyTest {
 protected:
  /// Makes square_number throw in these tiles.
  static void fail_in(std::set<std::int64_t> tiles) {
    toy::watch().in_square = [tiles = std::move(tiles)](const StageContext& unit) {
      if (tiles.contains(unit.tile().index))
        throw Error(ErrorCode::input, "the file is torn", "dem.tif", "mend it");
    };
  }
};

TEST_F(RunTest, GivesTheResultAndTheReport) {
  const RunResult result = run(pipeline);
  EXPECT_EQ(sum_of(result), "9+16+25+36=86");
  EXPECT_EQ(result.artifact<Number>("number").value, 3);
  EXPECT_THAT(ran(), ElementsAre(1, 4, 1));
  ASSERT_EQ(result.report.stages.size(), 3U);
  const StageReport& squares = result.report.stages[1];
  EXPECT_EQ(squares.stage, "square_number");
  EXPECT_EQ(squares.units, 4);
  EXPECT_EQ(squares.made, 4);
  EXPECT_EQ(squares.counts, (Counts{.in = 4, .out = 4, .rejected = {}}));
  EXPECT_TRUE(result.report.complete());
  EXPECT_EQ(result.report.exit_code(), 0);
}

TEST_F(RunTest, TakesOptionsOfEachStage) {
  pipeline.set("list_numbers.tiles=2").set("square_number.power=3").set("sum_squares.sign= and ");
  EXPECT_EQ(sum_of(run(pipeline)), "27 and 64=91");
}

TEST_F(RunTest, CountsRejectionsByReason) {
  pipeline.set("square_number.keep=even").set("square_number.loud=true");
  const RunResult result = run(pipeline);
  const StageReport& squares = result.report.stages[1];
  EXPECT_EQ(squares.counts, (Counts{.in = 4, .out = 2, .rejected = {{"not even", 2}}}));
  EXPECT_THAT(squares.warnings, ElementsAre("loud (tile_000000 and 3 more)"));
}

TEST_F(RunTest, NoTilesAreNoProblem) {
  pipeline.set("list_numbers.tiles=0");
  EXPECT_EQ(sum_of(run(pipeline)), "=0");
}

TEST_F(RunTest, DoesNotDependOnThreads) {
  pipeline.set("list_numbers.tiles=200").set("square_number.keep=even").set("square_number.loud=true");
  toy::watch().in_square = [](const StageContext& unit) {
    if (unit.tile().index % 7 == 3) throw std::runtime_error("torn");
  };
  const auto outcome = [&](int threads) {
    RunResult result = run(pipeline, {.threads = threads});
    for (StageReport& stage : result.report.stages) stage.seconds = 0;
    result.report.seconds = 0;
    return report_as_json(result.report);
  };
  const std::string alone = outcome(1);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(outcome(threads), alone);
}

TEST_F(RunTest, UsesTheThreadsItIsGiven) {
  pipeline.set("list_numbers.tiles=100");
  std::mutex mutex;
  std::condition_variable another;
  std::set<std::thread::id> seen;
  std::size_t awaited = 1;
  toy::watch().in_square = [&](const StageContext& unit) {
    EXPECT_GE(unit.threads(), 1);
    std::unique_lock lock(mutex);
    seen.insert(std::this_thread::get_id());
    another.notify_all();
    // On a busy machine the second thread may start late.
    another.wait_for(lock, std::chrono::seconds(60), [&] { return seen.size() >= awaited; });
  };
  run(pipeline, {.threads = 1});
  EXPECT_EQ(seen, std::set{std::this_thread::get_id()});
  awaited = 2;
  run(pipeline, {.threads = 4});
  EXPECT_GT(seen.size(), 1U);
  EXPECT_LE(seen.size(), 4U);
}

TEST_F(RunTest, FailuresStayAndTheOthersGoOn) {
  fail_in({1, 3});
  const RunResult result = run(pipeline);
  EXPECT_THAT(ran(), ElementsAre(1, 4, 0));
  EXPECT_EQ(result.report.exit_code(), 3);
  EXPECT_FALSE(result.report.complete());
  ASSERT_EQ(result.report.failures.size(), 2U);
  EXPECT_EQ(result.report.failures[0].unit, "square_number/tile_000001");
  EXPECT_EQ(result.report.failures[0].message, "the file is torn\n  dem.tif\n  mend it");
  EXPECT_EQ(result.report.failures[1].unit, "square_number/tile_000003");
  EXPECT_EQ(result.report.stages[1].failed, 2);
  EXPECT_EQ(result.report.stages[1].counts.out, 2);
  EXPECT_EQ(result.report.stages[2].skipped, 1);
  EXPECT_EQ(message_of([&] { sum_of(result); }),
            "'sum' was not made: square_number/tile_000001 failed\n  the file is torn\n  dem.tif\n  mend it");
}

TEST_F(RunTest, ABrokenDeclarationStopsTheRun) {
  toy::watch().in_square = [](const StageContext&) { throw std::logic_error("a bug"); };
  EXPECT_EQ(message_of<std::logic_error>([&] { run(pipeline); }), "a bug");
}

TEST_F(RunTest, AFailingListStopsTheRun) {
  pipeline.set("list_numbers.files=/nowhere/dem.tif");
  EXPECT_EQ(message_of([&] { run(pipeline); }),
            "cannot read an input file: No such file or directory\n  /nowhere/dem.tif\n"
            "  check the path in the job; it is relative to the job file");
}

TEST_F(RunTest, ChecksWithoutRunning) {
  const RunResult result = run(pipeline, {.check_only = true});
  EXPECT_THAT(ran(), ElementsAre(1, 0, 0));
  EXPECT_EQ(result.report.stages[1].waiting, 4);
  EXPECT_EQ(
      message_of([&] { sum_of(result); }),
      "'sum' was not made: part of the work is left\n  run without --check, --shard, --stage and --unit to "
      "finish the job");
}

TEST_F(RunTest, ChecksTheWiringFirst) {
  Pipeline broken(registry);
  broken.add("sum_squares");
  EXPECT_THROW(run(broken), Error);
}

TEST_F(RunTest, KeepsUnreadArtifactsAndReleasesTheRest) {
  const RunResult whole = run(pipeline);
  EXPECT_THAT(whole.artifacts<Number>("square"), testing::IsEmpty());
  Pipeline part(registry);
  part.add("list_numbers").add("square_number");
  EXPECT_EQ(run(part).artifacts<Number>("square").at(3)->value, 36);
}

TEST_F(RunTest, ResultsAreTakenOnce) {
  RunResult result = run(pipeline);
  const auto sums = result.take<std::string>("sum");
  ASSERT_EQ(sums.size(), 1U);
  EXPECT_EQ(sums[0], sum_of(run(pipeline)));
  EXPECT_THAT(result.artifacts<std::string>("sum"), testing::IsEmpty());
}

TEST_F(RunTest, ArtifactsAreAskedForByTheirType) {
  const RunResult result = run(pipeline);
  EXPECT_EQ(message_of<std::logic_error>([&] { result.artifact<Number>("sum"); }),
            "'sum' is a string of map scope, asked for as a Number of map scope");
  EXPECT_EQ(message_of<std::logic_error>([&] { result.artifact<Number>("square"); }),
            "'square' is a Number of tile scope, asked for as a Number of map scope");
  EXPECT_EQ(message_of<std::logic_error>([&] { result.artifact<Number>("tree"); }),
            "no stage of the run writes 'tree'");
}

TEST_F(RunTest, NamesEveryInputFileOnce) {
  std::ofstream(work / "a.txt") << "abc";
  pipeline.base_folder = work;
  pipeline.set(R"(list_numbers.files=["a.txt", "a.txt"])");
  const RunResult result = run(pipeline);
  ASSERT_EQ(result.inputs.size(), 1U);
  EXPECT_EQ(result.inputs[0].bytes, 3U);
  EXPECT_EQ(result.inputs[0].sha256, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_F(RunTest, TakesAnotherHasher) {
  pipeline.set("list_numbers.files=/vsimem/a.tif");
  const auto hasher = [](const std::string& path) {
    return InputFile{.path = path, .bytes = 7, .sha256 = "77"};
  };
  EXPECT_EQ(run(pipeline, {.hash_file = hasher}).inputs, (std::vector{hasher("/vsimem/a.tif")}));
}

TEST_F(RunTest, AFileThatCannotBeHashedFailsTheRun) {
  pipeline.set("list_numbers.files=gone.tif");
  EXPECT_THAT(message_of([&] { run(pipeline); }), HasSubstr("gone.tif"));
}

// The hash is still running when the stage's exception leaves the run, and throws afterwards.
TEST_F(RunTest, AStageAndAHashMayFailTogether) {
  pipeline.set("list_numbers.files=gone.tif");
  std::atomic<bool> leaving = false;
  toy::watch().in_square = [&](const StageContext&) {
    leaving = true;
    throw std::logic_error("a bug");
  };
  const auto hasher = [&](const std::string& path) -> InputFile {
    for (int i = 0; i < 1000 && !leaving; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    throw Error(ErrorCode::input, "the file cannot be read", path);
  };
  EXPECT_EQ(message_of<std::logic_error>([&] { run(pipeline, {.threads = 2, .hash_file = hasher}); }),
            "a bug");
}

TEST_F(RunTest, ReportsProgressUpToTheEndOfEachStage) {
  pipeline.set("list_numbers.tiles=50");
  toy::watch().in_square = [](const StageContext& unit) {
    for (const double done : {0.5, 0.25, 0.75, 2.0, std::nan("")}) unit.progress(done);
    std::this_thread::sleep_for(std::chrono::milliseconds(3));
  };
  std::vector<Progress> reported;
  run(pipeline, {.threads = 2, .progress = [&](const Progress& progress) { reported.push_back(progress); }});
  ASSERT_GE(reported.size(), 7U);
  EXPECT_EQ(reported.front().stage, "list_numbers");
  EXPECT_EQ(reported.back().stage, "sum_squares");
  for (std::size_t i = 0; i < reported.size(); ++i) {
    EXPECT_LE(reported[i].done, static_cast<double>(reported[i].total) + 1e-9);
    const bool last = i + 1 == reported.size() || reported[i + 1].stage != reported[i].stage;
    if (last)
      EXPECT_NEAR(reported[i].done, static_cast<double>(reported[i].total), 1e-9) << reported[i].stage;
    else
      EXPECT_LE(reported[i].done, reported[i + 1].done);
  }
}

TEST_F(RunTest, StagesThatCannotRunAreRefused) {
  EXPECT_EQ(message_of([&] { run(pipeline, {.stage = "square_number"}); }),
            "--shard, --stage, --unit and --rerun-from need the results of other runs\n  add --work DIR, the "
            "same for all of them");
  EXPECT_EQ(message_of([&] { run(pipeline, {.work = work, .stage = "square_numbers"}); }),
            "the job has no stage 'square_numbers' to run; did you mean 'square_number'?\n"
            "  its stages: list_numbers, square_number, sum_squares");
  EXPECT_EQ(
      message_of([&] { run(pipeline, {.work = work, .unit = "sum_squares/map", .stage = "sum_squares"}); }),
      "--unit is given together with --shard or --stage\n"
      "  a unit is the smallest part of a job: give --unit alone");
  ran();
  const std::string early = message_of([&] { run(pipeline, {.work = work, .stage = "sum_squares"}); });
  EXPECT_THAT(early,
              testing::StartsWith("cannot do sum_squares/map: it reads square_number/tile_000000, which "
                                  "is not done\n"));
  EXPECT_THAT(early, testing::EndsWith("\n  first do --stage square_number"));
  EXPECT_THAT(ran(), ElementsAre(1, 0, 0)) << "nothing but the list";
  // One shard of two is not enough, here the first two of four tiles; both are.
  run(pipeline, {.work = work, .shard = Shard{1, 2}, .stage = "square_number"});
  EXPECT_THAT(message_of([&] { run(pipeline, {.work = work, .stage = "sum_squares"}); }),
              testing::HasSubstr("square_number/tile_000002, which is not done"));
  run(pipeline, {.work = work, .shard = Shard{2, 2}, .stage = "square_number"});
  EXPECT_EQ(sum_of(run(pipeline, {.work = work, .stage = "sum_squares"})), sum_of(run(pipeline)));
}

TEST_F(RunTest, RefusesOptionsThatContradict) {
  EXPECT_EQ(message_of([&] { run(pipeline, {.threads = -1}); }),
            "cannot run with -1 threads\n  0 uses all threads of the machine");
  EXPECT_EQ(message_of([&] {
              run(pipeline, {.shard = Shard{1, 2}});
            }),
            "--shard, --stage, --unit and --rerun-from need the results of other runs\n  add --work DIR, the "
            "same for "
            "all of them");
  EXPECT_EQ(message_of([&] {
              run(pipeline, {.work = work, .shard = Shard{3, 2}});
            }),
            "shard 3/2 does not exist\n  shards count from 1: 1/8 to 8/8");
  EXPECT_EQ(
      message_of([&] { run(pipeline, {.work = work, .rerun_from = "square"}); }),
      "the job has no stage 'square' to rerun from\n  its stages: list_numbers, square_number, sum_squares");
  EXPECT_EQ(message_of([&] { run(pipeline, {.work = work, .unit = "square_number/tile_00001"}); }),
            "the job has no unit 'square_number/tile_00001'; did you mean 'square_number/tile_000001'?\n"
            "  waymark plan lists the units");
}

}  // namespace
}  // namespace waymark::test
