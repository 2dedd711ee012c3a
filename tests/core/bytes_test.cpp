// SPDX-License-Identifier: Apache-2.0
#include "core/bytes.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace waymark::test {
namespace {

RC_GTEST_PROP(Bytes, ReadBackWhatWasWritten,
              (const std::vector<double>& numbers, const std::string& text, int number)) {
  ByteWriter out;
  out(numbers), out(text), out(number);
  const std::string bytes = out.take();
  ByteReader in(bytes);
  std::vector<double> numbers_again;
  std::string text_again;
  in(numbers_again), in(text_again);
  RC_ASSERT(numbers_again == numbers);
  RC_ASSERT(text_again == text);
  RC_ASSERT(in.get<int>() == number);
  in.expect_end();
}

RC_GTEST_PROP(Bytes, ThatEndTooEarlyAreNoticed, (const std::vector<int>& numbers)) {
  ByteWriter out;
  out(numbers);
  std::string bytes = out.take();
  bytes.pop_back();
  ByteReader in(bytes);
  std::vector<int> again;
  RC_ASSERT_THROWS_AS(in(again), std::runtime_error);
}

TEST(Bytes, ALengthBeyondTheBytesIsNotAllocated) {
  ByteWriter out;
  out(std::uint64_t{1} << 60);
  const std::string bytes = out.take();
  ByteReader in(bytes);
  std::vector<double> values;
  EXPECT_THROW(in(values), std::runtime_error);
}

TEST(Bytes, LeftOverBytesAreNoticed) {
  ByteReader in("x");
  EXPECT_THROW(in.expect_end(), std::runtime_error);
}

}  // namespace
}  // namespace waymark::test
