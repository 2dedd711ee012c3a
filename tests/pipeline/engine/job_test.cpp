// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/job.hpp"

#include <fstream>

#include "tests/pipeline/engine/toy_test.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

const Registry kRegistry = toy::registry();

std::string refusal_of_job(std::string_view json) {
  return message_of([&] { parse_job(json, kRegistry, "alps.json"); });
}

constexpr std::string_view kJob = R"({"name": "numbers", "stages": [
  {"stage": "list_numbers", "tiles": 2, "files": ["one.txt"]}, {"stage": "square_number"}, {"stage": "sum_squares"}]})";

TEST(Job, IsReadWithItsFolder) {
  const TemporaryFolder folder;
  std::ofstream(folder / "job.json") << kJob;
  std::ofstream(folder / "one.txt") << "1";
  const Job job = read_job(folder / "job.json", kRegistry);
  EXPECT_EQ(job.name, "numbers");
  const RunResult result = run(job.pipeline);
  EXPECT_EQ(result.artifact<std::string>("sum"), "9+16=25");
  ASSERT_EQ(result.inputs.size(), 1U);
  EXPECT_EQ(result.inputs[0].path, (folder / "one.txt").string());
}

TEST(Job, ThatIsMissingSaysSo) {
  EXPECT_EQ(message_of([] { read_job("/nowhere/job.json", kRegistry); }),
            "cannot read the job file\n  /nowhere/job.json\n  check the path");
  EXPECT_EQ(message_of([] { read_job("/tmp", kRegistry); }),
            "cannot read the job file\n  /tmp\n  check the path");
}

TEST(Job, SyntaxErrorsHaveLineAndColumn) {
  EXPECT_THAT(refusal_of_job("{\n  \"name\": \"x\",\n  \"stages\" [\n]}"),
              testing::AllOf(testing::StartsWith("not valid JSON: expected ':' after a name"),
                             testing::HasSubstr("\n  alps.json:3:12")));
  EXPECT_THAT(refusal_of_job(""), testing::HasSubstr("\n  alps.json:1:1"));
  EXPECT_THAT(refusal_of_job("{\"name\": \"\xff\"}"),
              testing::HasSubstr("not valid JSON: this is not UTF-8\n  alps.json:1:11"));
}

TEST(Job, NamesThePlaceOfEveryOtherError) {
  EXPECT_EQ(refusal_of_job("[]"), "the job must be an object, is array\n  alps.json");
  EXPECT_EQ(refusal_of_job(R"({"name": 1, "stages": []})"), "name must be a string, is number\n  alps.json");
  EXPECT_EQ(refusal_of_job("{}"), "the job has no \"stages\"\n  alps.json\n  a job has a name and stages");
  EXPECT_EQ(refusal_of_job(R"({"stage": []})"),
            "the job has no 'stage'; did you mean 'stages'?\n  alps.json\n  a job has a name and stages");
  EXPECT_EQ(refusal_of_job(R"({"stages": {}})"), "stages must be an array, is object\n  alps.json");
  EXPECT_EQ(refusal_of_job(R"({"stages": ["x"]})"), "stages[0] must be an object, is string\n  alps.json");
  EXPECT_EQ(refusal_of_job(R"({"stages": [{}]})"),
            "stages[0] has no \"stage\"\n  alps.json\n  add the name of a stage");
  EXPECT_EQ(refusal_of_job(R"({"stages": [{"stage": 1}]})"),
            "stages[0].stage must be a string, is number\n  alps.json");
  EXPECT_EQ(refusal_of_job(R"({"stages": []})"), "the job has no stages\n  alps.json");
  EXPECT_EQ(refusal_of_job(R"({"stages": [{"stage": "list_numbers", "tiles": "many"}]})"),
            "stages[0].tiles must be a whole number, is a string (\"many\")\n  alps.json\n  How many tiles "
            "there are");
  EXPECT_EQ(refusal_of_job(R"({"stages": [{"stage": "sum_squares"}]})"),
            "stages[0] sum_squares reads 'square', which no stage before it writes\n  alps.json\n"
            "  add before it: square_number");
}

TEST(Job, RefusesAKeyGivenTwice) {
  EXPECT_EQ(refusal_of_job(R"({"stages": [{"stage": "list_numbers", "tiles": 1, "tiles": 2}]})"),
            "the key 'tiles' is given twice\n  alps.json");
  EXPECT_NO_THROW(
      parse_job(R"({"stages": [{"stage": "list_numbers"}, {"stage": "square_number"}]})", kRegistry));
}

TEST(Job, WritesItselfWithEveryOption) {
  const Job job = parse_job(kJob, kRegistry);
  const std::string text = job_as_json(job.name, job.pipeline);
  EXPECT_THAT(text, testing::HasSubstr(R"("power": 2.0)"));
  const Job again = parse_job(text, kRegistry);
  EXPECT_EQ(job_as_json(again.name, again.pipeline), text);
}

}  // namespace
}  // namespace waymark::test
