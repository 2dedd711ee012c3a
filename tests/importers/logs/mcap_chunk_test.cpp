// SPDX-License-Identifier: Apache-2.0
#include "importers/logs/mcap_chunk.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

#include "tests/support/message_of.hpp"

namespace waymark::test {
namespace {

using namespace std::string_literals;
using importers::unpacked_chunk;
using ::testing::HasSubstr;

const std::string kHead = "\x04\x22\x4D\x18\x40\x40\xC0"s, kStored = "\x0C\0\0\x80"s + "abcdefghijkl";

std::string refusal(const std::string& bytes, std::uint64_t size) {
  return message_of<std::runtime_error>([&] { unpacked_chunk("lz4", bytes, size); });
}

TEST(McapChunk, MatchesOfLz4ReachIntoEarlierBlocksAndOverTheirOwnEnd) {
  // 8 bytes from 12 back; then 2 literals and 18 bytes from 2 back; then 12 literals.
  const std::string block = "\x04\x0C\0"s +
                            "\x2E"
                            "xy"
                            "\x02\0"s +
                            "\xC0"
                            "end of block"s;  // 12 literals: a block ends with 5 or more
  const std::string frame =
      kHead + kStored + static_cast<char>(block.size()) + "\0\0\0"s + block + "\0\0\0\0"s;
  EXPECT_EQ(unpacked_chunk("lz4", frame, 52), "abcdefghijklabcdefghxyxyxyxyxyxyxyxyxyxyend of block");
  const std::string skipped = "\x50\x2A\x4D\x18\x02\0\0\0zz"s;
  EXPECT_EQ(unpacked_chunk("lz4", skipped + frame, 52).substr(40), "end of block");
}

TEST(McapChunk, RefusesWhatContradictsItself) {
  const std::string frame = kHead + kStored + "\0\0\0\0"s;
  EXPECT_EQ(unpacked_chunk("lz4", frame, 12), "abcdefghijkl");
  EXPECT_THAT(refusal(frame, 11), HasSubstr("more content"));
  EXPECT_THAT(refusal(frame, 13), HasSubstr("less content"));
  EXPECT_THAT(refusal(frame, std::uint64_t{1} << 40), HasSubstr("than it can hold"));
  EXPECT_THAT(refusal(frame.substr(0, 15), 12), HasSubstr("too early"));
  EXPECT_THAT(refusal(kHead + "\x03\0\0\0\x04\x0C\0"s, 12), HasSubstr("not there"));
  EXPECT_THAT(refusal("\x04\x22\x4D\x18\x41\x40\xC0"s, 12), HasSubstr("dictionary"));
}

}  // namespace
}  // namespace waymark::test
