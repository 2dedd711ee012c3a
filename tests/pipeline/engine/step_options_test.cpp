// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>

#include "pipeline/engine/step_options.hpp"
#include "tests/pipeline/engine/toy_test.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

using SquareStep = TypedStep<toy::SquareNumber>;

// The warnings of former names have tests of their own.
void read(Step& step, std::string_view json, std::string_view where) {
  static_cast<void>(read_options(step, json, where));
}
void set(Step& step, std::string_view option, std::string_view text) {
  static_cast<void>(set_option(step, option, text));
}

std::string canonical_after(std::string_view json) {
  SquareStep step;
  read(step, json, "stages[1]");
  return canonical_options(step);
}
std::string refusal_of_options(std::string_view json) {
  return message_of([&] { canonical_after(json); });
}

TEST(OptionReader, SetsEveryKind) {
  EXPECT_EQ(canonical_after(R"({"power": 3, "keep": "even", "height": 2.5, "loud": true, "memory": 7})"),
            R"({"height":2.5,"keep":"even","loud":true,"power":3.0})");
  TypedStep<toy::ListNumbers> list;
  read(list, R"({"tiles": 12.0, "files": ["a", "b"]})", "stages[0]");
  EXPECT_EQ(canonical_options(list), R"({"files":["a","b"],"tiles":12})");
}

TEST(OptionReader, NamesTheNearestOption) {
  EXPECT_EQ(refusal_of_options(R"({"powr": 3})"),
            "stages[1] square_number has no option 'powr'; did you mean 'power'?\n"
            "  its options: power, keep, height, loud, memory");
  EXPECT_EQ(refusal_of_options(R"({"xyz": 3})"),
            "stages[1] square_number has no option 'xyz'\n  its options: power, keep, height, loud, memory");
}

TEST(OptionReader, NamesTheKindItFoundInstead) {
  EXPECT_EQ(refusal_of_options(R"({"power": "high"})"),
            "stages[1].power must be a number, is a string (\"high\")\n  Exponent");
  EXPECT_EQ(refusal_of_options(R"({"power": null})"),
            "stages[1].power must be a number, is null\n  Exponent");
  EXPECT_EQ(refusal_of_options(R"({"loud": 1})"),
            "stages[1].loud must be true or false, is a number (1)\n  Warn in every tile");
  EXPECT_EQ(refusal_of_options(R"({"keep": ["all"]})"),
            "stages[1].keep must be a string, is an array ([\"all\"])\n  Which squares are kept");
  EXPECT_EQ(refusal_of_options(R"({"memory": 1.5})"),
            "stages[1].memory must be a whole number, is a number (1.5)\n  Bytes it may take");
  EXPECT_EQ(refusal_of_options(R"({"memory": 1e300})"),
            "stages[1].memory must be a whole number, is a number (1e+300)\n  Bytes it may take");
  EXPECT_EQ(
      refusal_of_options(R"({"memory": 18446744073709551615})"),
      "stages[1].memory must be a whole number, is a number (18446744073709551615)\n  Bytes it may take");
  TypedStep<toy::ListNumbers> list;
  EXPECT_EQ(message_of([&] { read(list, R"({"files": [1]})", "stages[0]"); }),
            "stages[0].files must be an array of strings, is an array ([1])\n  Files that count as read");
}

TEST(OptionReader, NamesTheRangeAndItsUnit) {
  EXPECT_EQ(refusal_of_options(R"({"power": 5})"), "stages[1].power = 5 is outside [0.5, 4]\n  Exponent");
  EXPECT_EQ(refusal_of_options(R"({"height": -1})"),
            "stages[1].height = -1 is not at least 0 m\n  A length | unused");
  EXPECT_EQ(refusal_of_options(R"({"memory": 0})"),
            "stages[1].memory = 0 is not at least 1\n  Bytes it may take");
}

TEST(OptionReader, NamesTheChoices) {
  EXPECT_EQ(refusal_of_options(R"({"keep": "evn"})"),
            "stages[1].keep must be one of all, even, none, is 'evn'; did you mean 'even'?\n  Which squares "
            "are kept");
  EXPECT_EQ(refusal_of_options(R"({"keep": "everything"})"),
            "stages[1].keep must be one of all, even, none, is 'everything'\n  Which squares are kept");
}

TEST(OptionReader, RefusesWhatIsNoObject) {
  EXPECT_EQ(refusal_of_options("[1]"), "the options of stages[1] square_number are not a JSON object: [1]");
  EXPECT_EQ(refusal_of_options("{"), "the options of stages[1] square_number are not a JSON object: {");
}

TEST(OptionReader, OptionsSetInCodeAreChecked) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message_of([&] { check_options(SquareStep({.power = nan}), "stages[1]"); }),
            "stages[1].power = nan is outside [0.5, 4]\n  Exponent");
  EXPECT_THROW(check_options(SquareStep({.height = Meters{nan}}), "stages[1]"), Error);
  EXPECT_NO_THROW(check_options(SquareStep(), "stages[1]"));
}

TEST(SetOption, ReadsTheCommandLine) {
  SquareStep step;
  set(step, "power", "3");
  set(step, "keep", "even");
  set(step, "loud", "true");
  EXPECT_EQ(canonical_options(step), R"({"height":20.0,"keep":"even","loud":true,"power":3.0})");
  TypedStep<toy::ListNumbers> list;
  set(list, "files", "a.tif");
  EXPECT_EQ(canonical_options(list), R"({"files":["a.tif"],"tiles":4})");
  set(list, "files", R"(["a.tif", "7"])");
  EXPECT_EQ(canonical_options(list), R"({"files":["a.tif","7"],"tiles":4})");
}

TEST(SetOption, SaysWhatWasTyped) {
  SquareStep step;
  EXPECT_EQ(message_of([&] { set(step, "power", "high"); }),
            "square_number.power must be a number, is a string (\"high\")\n  --set "
            "square_number.power=high\n  Exponent");
  EXPECT_EQ(message_of([&] { set(step, "powr", "3"); }),
            "square_number has no option 'powr'; did you mean 'power'?\n  --set square_number.powr=3\n"
            "  its options: power, keep, height, loud, memory");
  EXPECT_EQ(message_of([&] { set(step, "power", "nan"); }),
            "square_number.power must be a number, is a string (\"nan\")\n  --set square_number.power=nan\n  "
            "Exponent");
}

TEST(CanonicalOptions, FillDefaultsInAndLeaveOutWhatHasNoEffect) {
  EXPECT_EQ(canonical_options(SquareStep()), R"({"height":20.0,"keep":"all","loud":false,"power":2.0})");
  EXPECT_EQ(canonical_after(R"({"memory": 99})"), canonical_options(SquareStep()));
  EXPECT_EQ(canonical_after(R"({"loud": false, "power": 2})"), canonical_options(SquareStep()));
}

RC_GTEST_PROP(CanonicalOptions, ReadBackUnchanged, ()) {
  const double power = 0.5 + 3.5 * (*rc::gen::inRange(0, 1 << 30)) / (1 << 30);
  const SquareStep step({.power = power,
                         .keep = *rc::gen::element<std::string>("all", "even", "none"),
                         .height = Meters{std::abs(*rc::gen::arbitrary<double>())},
                         .loud = *rc::gen::arbitrary<bool>()});
  RC_ASSERT(canonical_after(canonical_options(step)) == canonical_options(step));
}

TEST(OptionTable, KeepsTheOrderOfDeclaration) {
  const auto rows = option_table(SquareStep());
  ASSERT_EQ(rows.size(), 5U);
  EXPECT_EQ(rows[0].name, "power");
  EXPECT_EQ(readable_range(rows[0]), "[0.5, 4]");
  EXPECT_EQ(rows[2].unit, "m");
  EXPECT_EQ(readable_range(rows[2]), "at least 0 m");
  EXPECT_EQ(json_type(rows[4].value), "integer");
  EXPECT_FALSE(rows[4].field.affects_result);
}

}  // namespace
}  // namespace waymark::test
