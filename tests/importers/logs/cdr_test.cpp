// SPDX-License-Identifier: Apache-2.0
#include "importers/logs/cdr.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <stdexcept>

namespace waymark::test {
using namespace importers;
namespace {

/// Writes a message by the letter of the standard: each number aligned to its size behind the first four
/// bytes.
class CdrWriter {
 public:
  explicit CdrWriter(bool little) : little_(little), bytes_{'\0', little ? '\1' : '\0', '\0', '\0'} {}

  template <class T>
  CdrWriter& add(T value) {
    while ((bytes_.size() - 4) % sizeof(T) != 0) bytes_ += '\x7f';
    std::string raw(reinterpret_cast<const char*>(&value), sizeof(T));
    if (!little_) std::ranges::reverse(raw);
    bytes_ += raw;
    return *this;
  }
  CdrWriter& add_text(const std::string& text) {
    add(static_cast<std::uint32_t>(text.size() + 1));
    bytes_ += text + '\0';
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  bool little_;
  std::string bytes_;
};

std::string message(bool little) {
  return CdrWriter(little)
      .add(std::uint8_t{250})
      .add(-0.1)
      .add_text("odom")
      .add(std::int32_t{-7})
      .add(std::uint32_t{2})
      .add(1.5F)
      .add(-2.5F)
      .add(std::uint16_t{65000})
      .add(std::int8_t{-3})
      .add(std::uint32_t{3})
      .add('a')
      .add('b')
      .add('c')
      .bytes();
}

void read_all(std::string_view bytes) {
  CdrReader in(bytes);
  EXPECT_EQ(in.number<std::uint8_t>(), 250);
  EXPECT_EQ(in.number<double>(), -0.1);
  EXPECT_EQ(in.text(), "odom");
  EXPECT_EQ(in.number<std::int32_t>(), -7);
  EXPECT_THAT(in.floats(), testing::ElementsAre(1.5F, -2.5F));
  EXPECT_EQ(in.number<std::uint16_t>(), 65000);
  EXPECT_EQ(in.number<std::int8_t>(), -3);
  EXPECT_EQ(in.bytes(in.count(1)), "abc");
}

TEST(Cdr, IsReadInBothByteOrders) {
  read_all(message(true));
  read_all(message(false));
}

TEST(Cdr, EndsNowhereUnnoticed) {
  for (const bool little : {true, false}) {
    const std::string whole = message(little);
    for (std::size_t size = 0; size < whole.size(); ++size)
      EXPECT_THROW(read_all(std::string(whole, 0, size)), std::runtime_error) << size;
  }
}

TEST(Cdr, LengthsBeyondTheMessageReserveNothing) {
  const std::string wild = CdrWriter(true).add(std::uint32_t{0xFFFFFFFF}).add(1.0F).bytes();
  EXPECT_THROW(CdrReader(wild).floats(), std::runtime_error);
  EXPECT_THROW(CdrReader(wild).text(), std::runtime_error);
  EXPECT_THROW(CdrReader(wild).count(1), std::runtime_error);
  EXPECT_THROW(CdrReader(wild).bytes(9), std::runtime_error);
  EXPECT_EQ(CdrReader(CdrWriter(true).add(std::uint32_t{0}).bytes()).text(), "");
}

TEST(Cdr, OtherEncapsulationsAreRefused) {
  EXPECT_THROW(CdrReader(std::string("\0\3\0\0", 4)), std::runtime_error);  // a parameter list
  EXPECT_THROW(CdrReader(std::string("\0\7\0\0", 4)), std::runtime_error);  // XCDR 2
}

}  // namespace
}  // namespace waymark::test
