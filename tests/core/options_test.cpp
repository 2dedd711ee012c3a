// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "core/options/option_reader.hpp"

namespace waymark::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Detector {
  double min_width = 0.25;
  std::int64_t threads = 1;
  bool fast = false;
  std::string model = "plain";
  std::vector<std::string> files = {};

  void describe(OptionVisitor& option) {
    option("min_width", min_width,
           {.help = "Smallest width kept", .min = 0, .max = 10, .formerly = "least_width"});
    option("threads", threads, {.help = "Threads to use", .min = 1, .affects_result = false});
    option("fast", fast, {.help = "Skip the second pass"});
    option("model", model, {.help = "Which model", .choices = {"plain", "curved"}});
    option("files", files, {.help = "Files to read"});
  }
};

class OptionsOfAll : public testing::Test {
 protected:
  std::vector<std::string> read(std::string_view json) { return read_options(describe_, json, where_); }
  std::vector<std::string> set(std::string_view name, std::string_view text) {
    return set_option(describe_, name, text, where_);
  }
  std::string refusal(const std::function<void()>& action) {
    try {
      action();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::usage);
      return error.what();
    }
    return "accepted";
  }

  Detector detector_;
  const DescribeOptions describe_ = [this](OptionVisitor& option) { detector_.describe(option); };
  const OptionLocation where_{
      .owner = "detector", .prefix = "detector.", .where = "a.json", .also = {"name"}};
};

TEST_F(OptionsOfAll, FormerNamesAreReadWithAWarning) {
  EXPECT_THAT(read(R"({"least_width": 3})"),
              ElementsAre("detector.least_width was renamed: use min_width (a.json)"));
  EXPECT_EQ(detector_.min_width, 3);
  EXPECT_THAT(set("least_width", "4"),
              ElementsAre("detector.least_width was renamed: use min_width (a.json)"));
  EXPECT_EQ(detector_.min_width, 4);
  EXPECT_THAT(read(R"({"min_width": 5, "name": "x"})"), IsEmpty());
  EXPECT_EQ(detector_.min_width, 5);
}

TEST_F(OptionsOfAll, ValuesOfFormerNamesAreChecked) {
  EXPECT_EQ(refusal([&] { (void)read(R"({"least_width": 11})"); }),
            "detector.min_width = 11 is outside [0, 10]\n  a.json\n  Smallest width kept");
  EXPECT_EQ(
      refusal([&] { (void)read(R"({"least_width": 1, "min_width": 2})"); }),
      "detector.least_width is the former name of detector.min_width, which is given as well\n  a.json\n"
      "  give min_width only");
}

TEST_F(OptionsOfAll, NamesBesidesTheOptionsArePermittedAndSuggested) {
  EXPECT_THAT(read(R"({"name": 7})"), IsEmpty());
  EXPECT_THAT(refusal([&] { (void)read(R"({"nam": 7})"); }),
              HasSubstr("detector has no option 'nam'; did you mean 'name'?"));
}

TEST_F(OptionsOfAll, NumbersOfTheCommandLineMayBeginOrEndWithThePoint) {
  EXPECT_THAT(set("min_width", ".5"), IsEmpty());
  EXPECT_EQ(detector_.min_width, 0.5);
  EXPECT_THAT(set("min_width", "+2."), IsEmpty());
  EXPECT_EQ(detector_.min_width, 2);
  EXPECT_THAT(set("threads", "9007199254740993"), IsEmpty());  // no double has this value
  EXPECT_EQ(detector_.threads, 9007199254740993);
  for (const char* text : {"nan", "inf", "1 m", "", "[", "0x10"})
    EXPECT_THAT(refusal([&] { (void)set("min_width", text); }), HasSubstr("must be a number, is a string"))
        << text;
}

TEST_F(OptionsOfAll, HelpAndSchemaGiveFormerNamesOnce) {
  const std::vector<OptionRow> rows = option_table(describe_);
  EXPECT_EQ(options_as_text(rows),
            "min_width=0.25  Smallest width kept (formerly least_width)\n"
            "threads=1  Threads to use\nfast=false  Skip the second pass\nmodel=plain  Which model\n"
            "files=  Files to read\n");
  EXPECT_EQ(options_as_json(rows),
            R"({"min_width":0.25,"threads":1,"fast":false,"model":"plain","files":[]})");
  EXPECT_EQ(canonical_options(rows), R"({"fast":false,"files":[],"min_width":0.25,"model":"plain"})");
  const std::string schemas = option_schemas(rows);
  EXPECT_THAT(schemas, HasSubstr(R"("maximum":10.0,"x-formerly":"least_width"})"));
  EXPECT_THAT(schemas,
              HasSubstr(R"("threads":{"type":"integer","description":"Threads to use","default":1,)"));
}

}  // namespace
}  // namespace waymark::test
