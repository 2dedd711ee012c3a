// SPDX-License-Identifier: Apache-2.0
#include "core/json_text.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

namespace waymark::test {
namespace {

/// Returns "line:column problem" of the fault; empty without one.
std::string fault_of(std::string_view text) {
  const auto fault = find_json_fault(text);
  return fault ? std::to_string(fault->line) + ":" + std::to_string(fault->column) + " " + fault->problem
               : "";
}

std::string repeated(std::string_view text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

constexpr const char* kSample =
    R"({"name": "Zürich \"\u00e9\ud83d\ude00\n", "empty": {}, "none": [], "n": null,
  "numbers": [0, -0, 1, -12.5, 0.25, 1e3, 2E-7, 3.5e+10, 123456789012345678901234567890],
  "nested": [[1, [true, false]], {"a": {"b": [{"c": "d"}]}}]})";

TEST(JsonText, AcceptsWhatTheStandardAccepts) {
  for (const char* text : {"0", " \t\r\n[1]\n", "\"\"", "true", "-0.0e-0", "\xEF\xBB\xBF{}", "1e-400",
                           "0e999999999999999999999", "1e308", kSample})
    EXPECT_EQ(fault_of(text), "") << text;
  EXPECT_EQ(fault_of("0." + repeated("0", 400) + "1e400"), "");
}

TEST(JsonText, FaultsHaveLineAndColumn) {
  EXPECT_EQ(fault_of(""), "1:1 the text ends where a value is expected");
  EXPECT_EQ(fault_of("{\n \"a\": 1,\n}"), "3:1 expected a name in double quotes");
  EXPECT_EQ(fault_of("{\"a\" 1}"), "1:6 expected ':' after a name");
  EXPECT_EQ(fault_of("[1\n 2]"), "2:2 expected ',' or ']' after a value");
  EXPECT_EQ(fault_of("{\"a\": 1 \"b\"}"), "1:9 expected ',' or '}' after a member");
  EXPECT_EQ(fault_of("[1,"), "1:4 the text ends where a value is expected");
  EXPECT_EQ(fault_of("[[]"), "1:4 the text ends in a list");
  EXPECT_EQ(fault_of("{} {}"), "1:4 there is more text after the end of the value");
  EXPECT_EQ(fault_of("[NaN]"), "1:2 expected a value");
  EXPECT_EQ(fault_of("[1.]"), "1:4 expected a digit");
  EXPECT_EQ(fault_of("\"a"), "1:3 a text has no closing quote");
  EXPECT_EQ(fault_of("\"\\x\""), "1:3 a backslash must be written twice");
  EXPECT_EQ(fault_of("\"\\ud800\""), "1:8 a high surrogate without a low one");
  EXPECT_EQ(fault_of("\"\xff\""), "1:2 this is not UTF-8");
  EXPECT_EQ(fault_of("\"\t\""), "1:2 a control character in a text must be written as \\n, \\t or \\u00XX");
  EXPECT_EQ(fault_of(std::string_view("1\0", 2)), "1:2 there is more text after the end of the value");
}

TEST(JsonText, NumbersThatNoDoubleHoldsAreFaults) {
  for (const std::string& number :
       {std::string("1e400"), std::string("-1e309"), "1" + repeated("0", 400), std::string("2e308"),
        std::string("1e99999999999999999999"), "0.001e" + repeated("9", 30)})
    EXPECT_EQ(fault_of("[\n" + number + "]"), "2:1 the number " + number.substr(0, 24) +
                                                  (number.size() > 24 ? "..." : "") +
                                                  " is too large: numbers go up to 1.797e308");
}

TEST(JsonText, DepthIsBounded) {
  const int most = static_cast<int>(kMaxJsonDepth);
  EXPECT_EQ(fault_of(repeated("[", most) + repeated("]", most)), "");
  EXPECT_EQ(fault_of(repeated("{\"a\":", most) + "1" + repeated("}", most)), "");
  const std::string fault = "1:65 objects and lists are nested more than 64 deep";
  EXPECT_EQ(fault_of(repeated("[", most + 1) + repeated("]", most + 1)), fault);
  EXPECT_EQ(fault_of(repeated("[", 5'000'000)), fault);
}

TEST(JsonText, CheckedTextNamesItsOrigin) {
  EXPECT_EQ(checked_json("[1]", "a.json"), "[1]");
  EXPECT_EQ(json_or_empty("[1]"), "[1]");
  EXPECT_EQ(json_or_empty("[1"), "");
  try {
    checked_json("[\n1", "a.json", ErrorCode::usage);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_STREQ(
        error.what(),
        "not valid JSON: the text ends in a list\n  a.json:2:2\n  correct it there; a damaged file must "
        "be written again");
  }
}

// The slow twin is the parser that builds the values. It takes a NUL for the end of the text, and depth does
// not bound it.
TEST(JsonText, AgreesWithTheParserOnMutations) {
  std::mt19937 random(2026);
  const std::string alphabet = "{}[]\",:0123456789.eE+-\\utrfn \n\x80\xC3\xA9\xED\xF0";
  int good = 0;
  for (int round = 0; round < 40'000; ++round) {
    std::string text = kSample;
    const auto any = [&](std::size_t below) { return random() % std::max<std::size_t>(below, 1); };
    for (auto changes = 1 + any(3); changes > 0; --changes) {
      const std::size_t at = any(text.size());
      switch (any(5)) {
        case 0:
          text[at] = alphabet[any(alphabet.size())];
          break;
        case 1:
          text.erase(at, 1 + any(4));
          break;
        case 2:
          text.insert(at, 1, alphabet[any(alphabet.size())]);
          break;
        case 3:
          text.insert(at, text.substr(any(text.size()), any(12)));
          break;
        default:
          text.insert(at, repeated("9", static_cast<int>(any(320))));
      }
    }
    const bool accepted = nlohmann::json::accept(text);
    good += accepted;
    ASSERT_EQ(!find_json_fault(text), accepted) << "round " << round << "\n"
                                                << text << "\n"
                                                << fault_of(text);
  }
  EXPECT_GT(good, 2000);
}

}  // namespace
}  // namespace waymark::test
