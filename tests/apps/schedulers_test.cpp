// SPDX-License-Identifier: Apache-2.0
// Real schedulers make the map of one machine, though their tasks are killed.
#include <gmock/gmock.h>

#include <algorithm>
#include <sstream>

#include "made_dem.hpp"
#include "program.hpp"

namespace waymark::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A job of a thousand tiles and a program on the PATH that is killed ten times.
class Schedulers : public testing::Test {
 protected:
  void SetUp() override {
    const std::string dem = make_dem(folder_ / "hills.tif", hills(2048, 2048));
    write_text(folder_ / "job.json", waymark({"peaks", dem, "--tile-cells", "64", "--print-job"}).out);
    write_text(folder_ / "waymark", R"sh(#!/bin/bash
# Runs the program; as long as fewer than ten calls were killed, kills it after up to .4 s.
cd "$(dirname "$0")"
if [ "$(ls kills | wc -l)" -lt 10 ]; then
  timeout --signal=KILL 0.$((RANDOM % 40 + 10)) "$WAYMARK" "$@" && exit
  code=$?
  mktemp kills/XXXXXXXX >/dev/null
  exit $code
fi
exec "$WAYMARK" "$@"
)sh");
    ASSERT_EQ(in_folder("mkdir kills && chmod +x waymark").code, 0);
    ASSERT_EQ(in_folder(kWholeJob + " -o one_machine.gpkg").code, 0);
    ASSERT_EQ(in_folder("mv one_machine.gpkg expected && rm -r work").code, 0);
  }

  /// Runs a line in the folder, which comes first on the PATH. Times do not enter maps.
  Outcome in_folder(const std::string& line) {
    return bash("cd '" + folder_.path().string() +
                "' && export PATH=$PWD:$PATH SOURCE_DATE_EPOCH=0 WAYMARK && " + line);
  }
  long kills() { return std::ranges::distance(std::filesystem::directory_iterator(folder_ / "kills")); }
  std::string landmarks(const std::string& map) {
    return waymark({"query", folder_ / map, "--format", "csv"}).out;
  }
  /// Expects the landmarks of one machine from the scheduler, and that all work is in the work folder.
  void expect_map_of_one_machine() {
    EXPECT_GE(kills(), 10);
    EXPECT_EQ(landmarks("map.gpkg"), landmarks("expected"));
    EXPECT_EQ(in_folder(kWholeJob + " -o one_machine.gpkg && cmp one_machine.gpkg expected").code, 0);
  }

  static inline const std::string kResources =
      " --resources cpus=1,memory=300M,time=30 --resources map:memory=1G";
  static inline const std::string kWholeJob = "$WAYMARK run job.json --work work";
  TempFolder folder_;
};

TEST_F(Schedulers, GnuParallelIsResumedUntilTheMapIsMade) {
  if (bash("parallel --version | grep GNU").code != 0) GTEST_SKIP() << "needs GNU parallel";
  ASSERT_EQ(in_folder("waymark --version; $WAYMARK plan job.json --as parallel --shards 8" + kResources +
                      " -o map.gpkg > run.sh")
                .code,
            0);
  for (int round = 0; round < 40 && !std::filesystem::exists(folder_ / "map.gpkg"); ++round)
    in_folder("sh run.sh");
  expect_map_of_one_machine();
}

TEST_F(Schedulers, SnakemakeTriesKilledTasksAgain) {
  if (bash("snakemake --version").code != 0) GTEST_SKIP() << "needs snakemake";
  ASSERT_EQ(
      in_folder("$WAYMARK plan job.json --as snakemake --shards 8" + kResources + " -o map.gpkg > Snakefile")
          .code,
      0);
  const Outcome ran = in_folder("snakemake -j 2 --retries 12 --latency-wait 5");
  EXPECT_EQ(ran.code, 0) << ran.err;
  expect_map_of_one_machine();
  EXPECT_THAT(in_folder("snakemake -j 2").err, HasSubstr("Nothing to be done"));
}

TEST_F(Schedulers, SlurmMakesTheMapAfterJobsAreSubmittedAgain) {
  const std::string site = WAYMARK_SOURCE_DIR "/tests/apps/slurm_site ";
  if (bash(site + "--available").code != 0)
    GTEST_SKIP() << "needs root, slurmctld, slurmd, slurm-client and munge";
  ASSERT_EQ(
      in_folder("$WAYMARK plan job.json --as slurm --shards 8" + kResources + " -o map.gpkg > submit.sh")
          .code,
      0);
  const Outcome ran = in_folder(site +
                                "'for i in $(seq 40); do [ -e map.gpkg ] || { sh submit.sh && "
                                "while [ -n \"$(squeue --noheader)\" ]; do sleep 0.5; done; }; done'");
  EXPECT_EQ(ran.code, 0) << ran.err;
  expect_map_of_one_machine();
}

/// The lines of docs/tutorials/many_tiles_on_a_cluster.md, to the letter.
class ClusterTutorial : public testing::Test {
 protected:
  void SetUp() override {
    std::istringstream page(text_of(WAYMARK_SOURCE_DIR "/docs/tutorials/many_tiles_on_a_cluster.md"));
    bool is_code = false;  // lines that need a scheduler have no language: the test of pages skips them
    for (std::string line; std::getline(page, line);) {
      if (line.starts_with("```")) {
        is_code = !is_code;
        if (is_code) blocks_.emplace_back();
      } else if (is_code) {
        blocks_.back() += line + "\n";
      }
    }
    ASSERT_EQ(blocks_.size(), 7U);
    if (bash("command -v gdal_translate").code != 0) GTEST_SKIP() << "needs gdal-bin";
    bash("mkdir '" + (folder_ / "bin") + "' && ln -s \"$WAYMARK\" '" + (folder_ / "bin/waymark") +
         "' && cp -r '" + WAYMARK_SOURCE_DIR + "/sample_data' '" + folder_.path().string() + "'");
    const Outcome made = follow(blocks_[0] + blocks_[1]);
    ASSERT_EQ(made.code, 0) << made.err;
    // Two stages on each of about 500 tiles, and a few on the map.
    EXPECT_GT(std::stoi(made.out), 500);
  }
  Outcome follow(const std::string& lines) {
    const bool is_begun = std::filesystem::exists(folder_ / "cluster");
    return bash("set -e; cd '" + folder_.path().string() + (is_begun ? "/cluster" : "") + "'; export PATH='" +
                (folder_ / "bin") + "':$PATH\n" + lines);
  }
  void expect_same_landmarks() {
    const Outcome same = follow(blocks_[5]);
    EXPECT_EQ(same.code, 0) << same.err;
    EXPECT_THAT(same.out, HasSubstr("the same landmarks"));
    const Outcome planned = follow(blocks_[6]);
    EXPECT_EQ(planned.code, 0) << planned.err;
    EXPECT_THAT(planned.err, Not(HasSubstr("measured")));  // nothing that is left is unknown
    EXPECT_THAT(text_of(folder_ / "cluster/measured.sh"),
                testing::ContainsRegex("name=map .*--mem=[0-9]+00M --time=120"));
  }

  TempFolder folder_;
  std::vector<std::string> blocks_;
};

TEST_F(ClusterTutorial, WithSlurm) {
  const std::string site = WAYMARK_SOURCE_DIR "/tests/apps/slurm_site ";
  if (bash(site + "--available").code != 0)
    GTEST_SKIP() << "needs root, slurmctld, slurmd, slurm-client and munge";
  write_text(folder_ / "cluster/lines",
             blocks_[2] + "while [ -n \"$(squeue --noheader)\" ]; do sleep 0.2; done\n" + blocks_[6] +
                 "sh measured.sh; while [ -n \"$(squeue --noheader)\" ]; do sleep 0.2; done\n");
  const Outcome ran = follow(site + "'sh lines'");
  EXPECT_EQ(ran.code, 0) << ran.err;
  expect_same_landmarks();
}

TEST_F(ClusterTutorial, WithSnakemake) {
  if (bash("snakemake --version").code != 0) GTEST_SKIP() << "needs snakemake";
  const Outcome ran = follow(blocks_[3]);
  EXPECT_EQ(ran.code, 0) << ran.err;
  expect_same_landmarks();
}

TEST_F(ClusterTutorial, WithGnuParallel) {
  if (bash("parallel --version | grep GNU").code != 0) GTEST_SKIP() << "needs GNU parallel";
  const Outcome ran = follow(blocks_[4]);
  EXPECT_EQ(ran.code, 0) << ran.err;
  expect_same_landmarks();
}

}  // namespace
}  // namespace waymark::test
