// SPDX-License-Identifier: Apache-2.0
#include "core/printable.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/error.hpp"

namespace waymark::test {
namespace {

TEST(Printable, TextStaysText) {
  for (const char* text : {"", "a\tb\nc", "Zürich, 東京 😀"}) EXPECT_EQ(printable(text), text);
}

TEST(Printable, WhatControlsATerminalIsEscaped) {
  EXPECT_EQ(printable("\x1b[31mred\x07"), "\\x1b[31mred\\x07");
  EXPECT_EQ(printable("a\r\nb\x7f"), "a\\x0d\nb\\x7f");
  EXPECT_EQ(printable("\xc2\x9b"
                      "2J"),
            "\\xc2\\x9b2J");
  EXPECT_EQ(printable("evil\u202egpj.exe"), "evil\\xe2\\x80\\xaegpj.exe");
  EXPECT_EQ(printable("\u2067"), "\\xe2\\x81\\xa7");
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a\\x00b");
}

TEST(Printable, BytesThatAreNotUtf8AreEscaped) {
  EXPECT_EQ(printable("caf\xe9"), "caf\\xe9");
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");           // overlong
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // a surrogate
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
}

TEST(Printable, LongTextsAreCutInTheMiddle) {
  EXPECT_EQ(printable(std::string(90, 'a') + std::string(90, 'b'), 90),
            std::string(60, 'a') + " ... 90 bytes ... " + std::string(30, 'b'));
  std::string umlauts;
  for (int i = 0; i < 100; ++i) umlauts += "ü";
  for (std::size_t most = 30; most < 40; ++most)
    EXPECT_EQ(printable(umlauts, most).find('\\'), std::string::npos) << "cut inside a character";
}

TEST(Printable, AnyBytesGiveUtf8WithoutControls) {
  std::mt19937 random(7);
  for (int round = 0; round < 20'000; ++round) {
    std::string bytes;
    for (auto count = random() % 40; count > 0; --count) bytes += static_cast<char>(random() % 256);
    const std::string safe = printable(bytes, 30);
    for (std::string_view rest = safe; !rest.empty(); rest.remove_prefix(utf8_length(rest))) {
      ASSERT_GT(utf8_length(rest), 0U) << "round " << round;
      ASSERT_TRUE(static_cast<unsigned char>(rest[0]) >= 0x20 || rest[0] == '\n' || rest[0] == '\t');
    }
  }
}

TEST(Error, MessagesFitAScreenAndHoldNoControls) {
  const Error error(ErrorCode::input, "the layer '\x1b[2J" + std::string(100'000, 'x') + "' is missing",
                    "/tmp/" + std::string(5000, 'y') + ".gpkg", std::string(9000, 'z'));
  const std::string said = error.what();
  EXPECT_LT(said.size(), 3000U);
  EXPECT_NE(said.find("\\x1b[2J"), std::string::npos);
  EXPECT_NE(said.find("' is missing\n  /tmp/"), std::string::npos);
  EXPECT_NE(said.find(".gpkg\n"), std::string::npos) << "the end of a path says most";
  EXPECT_GT(error.problem().size(), 100'000U) << "the parts stay as they were given";
}

}  // namespace
}  // namespace waymark::test
