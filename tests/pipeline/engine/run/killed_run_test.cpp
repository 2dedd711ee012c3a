// SPDX-License-Identifier: Apache-2.0
// Several processes use one work folder; some of them are killed. The child is this program.
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <optional>
#include <random>
#include <thread>

#include "core/locked_folder.hpp"
#include "tests/pipeline/engine/toy_test.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

namespace fs = std::filesystem;

constexpr const char* kWork = "WAYMARK_TEST_WORK";
constexpr std::int64_t kLongTiles = 60;

Pipeline long_pipeline(const Registry& registry) {
  Pipeline pipeline = toy_pipeline(registry);
  pipeline.set("list_numbers.tiles=" + std::to_string(kLongTiles));
  return pipeline;
}

/// Test body of a child in the work folder given by the environment; else a test with its own folder.
TEST(KilledRunChild, Runs) {
  const char* given = std::getenv(kWork);
  std::optional<TemporaryFolder> own;
  const fs::path work = given ? fs::path(given) : fs::path(own.emplace());
  toy::watch().in_square = [](const StageContext&) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  const Registry registry = toy::registry();
  EXPECT_TRUE(run(long_pipeline(registry), {.work = work, .threads = 2}).report.complete());
}

class Child {
 public:
  explicit Child(const fs::path& work) {
    std::string program = fs::read_symlink("/proc/self/exe"), filter = "--gtest_filter=KilledRunChild.*",
                brief = "--gtest_brief=1";
    char* arguments[] = {program.data(), filter.data(), brief.data(), nullptr};
    std::string variable = kWork;
    variable += '=';
    variable += work.string();
    char* environment[] = {variable.data(), nullptr};
    if (posix_spawn(&process_, program.c_str(), nullptr, nullptr, arguments, environment) != 0)
      ADD_FAILURE() << "cannot start " << program;
  }
  void kill() const { ::kill(process_, SIGKILL); }
  /// Returns the exit code, or -1 if it was killed.
  int wait() const {
    int status = 0;
    waitpid(process_, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t process_ = 0;
};

class KilledRun : public ToyTest {
 protected:
  std::string sum_in_memory() const { return sum_of(run(long_pipeline(registry))); }
  std::string resumed_sum() const { return sum_of(run(long_pipeline(registry), {.work = work})); }
  int leftovers() const { return count_below(work, ".waymark-"); }
  int results() const { return count_below(work, "manifest.json"); }

 private:
  /// Counts entries whose names begin with `begin`; the folder may change meanwhile.
  static int count_below(const fs::path& folder, std::string_view begin) {
    int count = 0;
    std::error_code ignored;
    for (fs::recursive_directory_iterator entry(folder, ignored), end; !ignored && entry != end;
         entry.increment(ignored))
      count += entry->path().filename().string().starts_with(begin);
    return count;
  }
};

// Each child is killed at a random moment after it has made at least one more result.
TEST_F(KilledRun, GoesOnWhereItWas) {
  const std::string expected = sum_in_memory();
  std::mt19937 random(7);
  constexpr int kRounds = 8;
  for (int round = 1; round <= kRounds; ++round) {
    const int before = results();
    const Child child(work);
    while (results() == before) std::this_thread::sleep_for(std::chrono::microseconds(200));
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 8'000));
    child.kill();
    child.wait();
    const bool too_quick = results() > kLongTiles;
    if (too_quick && round < kRounds) fs::remove_all(work / "square_number");  // start over
  }
  const int left = results();
  EXPECT_GT(left, 0);
  ran();
  EXPECT_EQ(resumed_sum(), expected);
  EXPECT_LT(ran()[1], kLongTiles) << "killed runs have left results";
  EXPECT_EQ(run(long_pipeline(registry), {.work = work}).report.stages[1].reused, kLongTiles);
  EXPECT_EQ(leftovers(), 0);
}

// A process can be killed when its result is in place, and its hidden folder still there.
TEST_F(KilledRun, LeavesNothingBesideAFinishedResult) {
  resumed_sum();
  const fs::path dead = work / "sum_squares/map/.waymark-999999999-a-host-abcdef";
  fs::create_directories(dead);
  resumed_sum();
  EXPECT_FALSE(fs::exists(dead));
}

TEST_F(KilledRun, LeavesNothingForGood) {
  fs::create_directories(work / "sum_squares/map");
  const fs::path dead = work / "sum_squares/map/.waymark-999999999-a-host-abcdef";
  fs::create_directories(dead / "result");
  const LockedFolder alive(work / "sum_squares/map");
  resumed_sum();
  EXPECT_FALSE(fs::exists(dead));
  EXPECT_TRUE(fs::exists(alive.path()));
}

TEST_F(KilledRun, TwoProcessesFinishTheSameFolder) {
  for (int round = 0; round < 3; ++round) {
    fs::remove_all(work);
    const Child one(work), other(work);
    EXPECT_EQ(one.wait(), 0);
    EXPECT_EQ(other.wait(), 0);
    ran();
    EXPECT_EQ(resumed_sum(), sum_in_memory());
    EXPECT_EQ(leftovers(), 0);
  }
}

}  // namespace
}  // namespace waymark::test
