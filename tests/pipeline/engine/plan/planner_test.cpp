// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/runner.hpp"

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/text_file.hpp"
#include "tests/pipeline/engine/toy_test.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

using testing::HasSubstr;

class PlanTest : public ToyTest {
 protected:
  PlanTest() { pipeline.set("list_numbers.tiles=2"); }
  Plan the_plan() { return plan(pipeline, {.work = work}); }
  const PlanCommand command{.job = "my job.json", .work = "work"};
};

TEST_F(PlanTest, ListsUnitsAfterWhatTheyRead) {
  const Plan plan = the_plan();
  std::vector<std::string> ids;
  for (const Unit& unit : plan.units) ids.push_back(unit.id());
  EXPECT_THAT(ids, testing::ElementsAre("list_numbers/map", "square_number/tile_000000",
                                        "square_number/tile_000001", "sum_squares/map"));
  EXPECT_THAT(plan.units[0].after, testing::IsEmpty());
  EXPECT_THAT(plan.units[2].after, testing::ElementsAre(0));
  EXPECT_THAT(plan.units[3].after, testing::ElementsAre(1, 2));
  EXPECT_THAT(plan.begins, testing::ElementsAre(0, 1, 3, 4));
  EXPECT_THAT(ran(), testing::ElementsAre(1, 0, 0)) << "only the list is made";
}

TEST_F(PlanTest, FingerprintsAreTheSameEverywhere) {
  const Plan kept = the_plan(), in_memory = plan(pipeline);
  for (std::size_t i = 0; i < kept.units.size(); ++i) {
    EXPECT_EQ(kept.units[i].fingerprint.size(), 32U);
    EXPECT_EQ(kept.units[i].fingerprint, in_memory.units[i].fingerprint);
  }
  EXPECT_NE(kept.units[1].fingerprint, kept.units[2].fingerprint);
}

TEST_F(PlanTest, JsonLines) {
  run(pipeline, {.work = work, .unit = "square_number/tile_000001"});
  std::istringstream lines(plan_as_jsonl(the_plan()));
  std::vector<nlohmann::json> units;
  for (std::string line; std::getline(lines, line);) units.push_back(nlohmann::json::parse(line));
  ASSERT_EQ(units.size(), 4U);
  EXPECT_EQ(units[2]["unit"], "square_number/tile_000001");
  EXPECT_EQ(units[2]["done"], true);
  EXPECT_EQ(units[3]["done"], false);
  EXPECT_EQ(units[3]["after"], (nlohmann::json{"square_number/tile_000000", "square_number/tile_000001"}));
}

TEST(PlanFormats, JsonLinesOfAnyNames) {
  const std::string odd = "a \"b\" \\ \n \x01 \xc3\xbc.tif";
  Plan plan;
  plan.units.resize(2);
  plan.units[0].stage = "detect", plan.units[0].item = odd;
  plan.units[1].stage = "merge", plan.units[1].after = {0};
  std::istringstream lines(plan_as_jsonl(plan));
  std::string first, second;
  std::getline(lines, first), std::getline(lines, second);
  EXPECT_EQ(nlohmann::json::parse(first)["item"], odd);
  EXPECT_EQ(nlohmann::json::parse(second)["after"], nlohmann::json{"detect/" + odd});
}

TEST_F(PlanTest, Snakemake) {
  const Plan plan = the_plan();
  const std::string file = plan_as_snakemake(plan, command);
  EXPECT_THAT(file, testing::ContainsRegex(
                        "rule square_number:\n    input: \"work/shards/list_numbers-[0-9a-f]{16}\"\n"
                        "    output: touch\\(\"work/shards/square_number-[0-9a-f]{16}/"
                        "\\{shard\\}_of_2\"\\)\n    shell: \"waymark run 'my job.json' --work work "
                        "--stage square_number --shard \\{wildcards.shard\\}/2\"\n"));
  EXPECT_THAT(file, testing::ContainsRegex(
                        "rule sum_squares:\n    input: expand\\(\"work/shards/square_number-[0-9a-f]{16}/"
                        "\\{shard\\}_of_2\", shard=range\\(1, 3\\)\\)\n"));
  EXPECT_THAT(plan_as_snakemake(plan, {.job = "{a}.json", .work = "w"}),
              HasSubstr("run '{{a}}.json' --work w"));
}

TEST_F(PlanTest, FormsForSchedulersDoNotGrowWithTheTiles) {
  pipeline.set("list_numbers.tiles=20000");
  const Plan plan = the_plan();
  ASSERT_GT(plan.units.size(), 20000);
  for (const auto& form : {plan_as_snakemake, plan_as_slurm, plan_as_parallel})
    EXPECT_LT(form(plan, command).size(), 2000);
}

TEST_F(PlanTest, MarksOfShardsDifferWhereResultsDo) {
  const std::string before = plan_as_snakemake(the_plan(), command);
  EXPECT_EQ(plan_as_snakemake(the_plan(), command), before);
  pipeline.set("list_numbers.tiles=3");
  EXPECT_EQ(before.find("_of_3"), std::string::npos);
  EXPECT_NE(plan_as_snakemake(the_plan(), command), before);
}

TEST_F(PlanTest, ShardsAreLimited) {
  pipeline.set("list_numbers.tiles=9");
  const PlanCommand limited{.job = "j.json", .work = "w", .map = {}, .max_shards = 4};
  EXPECT_THAT(plan_as_slurm(the_plan(), limited), HasSubstr("--array=1-4"));
  EXPECT_THAT(plan_as_slurm(the_plan(), limited), HasSubstr("--shard $SLURM_ARRAY_TASK_ID/4"));
  EXPECT_THAT(plan_as_snakemake(the_plan(), limited), HasSubstr("shard=range(1, 5)"));
}

// A fake sbatch prints a job number and logs its arguments.
TEST_F(PlanTest, SlurmSubmitsStagesInOrder) {
  std::ofstream(work / "sbatch") << "#!/bin/sh\necho \"$@\" >> '" << (work / "calls").string()
                                 << "'\nwc -l < '" << (work / "calls").string() << "' | tr -d ' '\n";
  std::ofstream(work / "submit.sh") << plan_as_slurm(the_plan(), command);
  std::filesystem::permissions(work / "sbatch", std::filesystem::perms::owner_all);
  const std::string folder = std::filesystem::path(work).string();
  ASSERT_EQ(std::system(("PATH=" + folder + ":$PATH sh " + folder + "/submit.sh").c_str()), 0);
  EXPECT_EQ(read_text(work / "calls", "the calls"),
            "--parsable --job-name=list_numbers --wrap waymark run 'my job.json' --work work --stage "
            "list_numbers\n"
            "--parsable --job-name=square_number --dependency=afterok:1 --kill-on-invalid-dep=yes "
            "--array=1-2 --wrap "
            "waymark run 'my job.json' --work work --stage square_number --shard $SLURM_ARRAY_TASK_ID/2\n"
            "--parsable --job-name=sum_squares --dependency=afterok:2 --kill-on-invalid-dep=yes --wrap "
            "waymark run 'my job.json' --work work --stage sum_squares\n");
}

TEST_F(PlanTest, CallsAskForResources) {
  const PlanCommand call{.job = "j.json",
                         .work = "w",
                         .map = "m.gpkg",
                         .resources = {{"", {.processors = 2, .megabytes = 2000, .minutes = 60}},
                                       {"sum_squares", {.megabytes = 16000}},
                                       {"map", {.minutes = 5}}}};
  const std::string slurm = plan_as_slurm(the_plan(), call);
  EXPECT_THAT(slurm,
              HasSubstr("--array=1-2 --cpus-per-task=2 --mem=2000M --time=60 --wrap 'waymark run j.json "
                        "--work w --threads 2 --stage square_number --shard"));
  EXPECT_THAT(slurm, HasSubstr("--mem=16000M --wrap 'waymark run j.json --work w --stage sum_squares'"));
  EXPECT_THAT(slurm,
              HasSubstr("--kill-on-invalid-dep=yes --time=5 --wrap 'waymark run j.json --work w -o m"));
  const std::string snakefile = plan_as_snakemake(the_plan(), call);
  EXPECT_THAT(snakefile,
              HasSubstr("    threads: 2\n    resources: mem_mb=2000, runtime=60\n    shell: \"waymark "
                        "run j.json --work w --threads 2 --stage square_number"));
  EXPECT_THAT(snakefile, HasSubstr("    resources: mem_mb=16000\n"));
  EXPECT_THAT(snakefile, HasSubstr("    output: \"m.gpkg\"\n    resources: runtime=5\n    shell"));
  EXPECT_THAT(
      plan_as_parallel(the_plan(), call),
      HasSubstr("seq 2 | parallel --halt now,fail=1 --jobs 50% --memfree 2000M --timeout 3600 'waymark"));
}

TEST_F(PlanTest, EndsInTheMapWithTheSettings) {
  const PlanCommand call{.job = "j.json",
                         .work = "w",
                         .options = {"--config", "A=b", "--allow-network"},
                         .settings = {"a.b=c d"},
                         .map = "{m}.gpkg"};
  const std::string run = "waymark run j.json --work w --config 'A=b' --allow-network --set 'a.b=c d'";
  const std::string snakefile = plan_as_snakemake(the_plan(), call);
  EXPECT_THAT(snakefile, HasSubstr("\nrule map:\n    input: \"w/shards/list_numbers-"));
  EXPECT_THAT(snakefile,
              HasSubstr("\n    output: \"{m}.gpkg\"\n    shell: \"" + run + " -o '{{m}}.gpkg'\"\n"));
  EXPECT_THAT(plan_as_slurm(the_plan(), call),
              HasSubstr("map=$(sbatch --parsable --job-name=map "
                        "--dependency=afterok:$stage_0:$stage_1:$stage_2 --kill-on-invalid-dep=yes --wrap "));
  EXPECT_THAT(plan_as_parallel(the_plan(), {.job = "j.json", .work = "w", .map = "m.gpkg"}),
              testing::EndsWith(
                  "waymark run j.json --work w --stage list_numbers\n"
                  "seq 2 | parallel --halt now,fail=1 'waymark run j.json --work w --stage square_number "
                  "--shard {}/2'\n"
                  "waymark run j.json --work w --stage sum_squares\n"
                  "waymark run j.json --work w -o m.gpkg\n"));
}

}  // namespace
}  // namespace waymark::test
