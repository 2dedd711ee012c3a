// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>
namespace waymark::importers {

/// Reads values of a message in the Common Data Representation (OMG DDSI-RTPS 2.3, section 10), as ROS 2
/// writes it, by eProsima Fast CDR. Throws std::runtime_error if the bytes end too early or have another
/// encapsulation; reserves no more than the message holds.
class CdrReader {
 public:
  /// The bytes stay as they are while it reads.
  explicit CdrReader(std::string_view message);
  ~CdrReader();

  /// Reads an integer of 8 or 32 bits, a uint16_t, a float or a double.
  template <class T>
  T number();
  std::string text();
  std::vector<float> floats();

  /// Reads the length of a sequence whose items take at least `item_size` bytes.
  std::size_t count(std::size_t item_size);
  /// Returns the next `size` bytes of the message.
  std::string_view bytes(std::size_t size);

 private:
  struct Stream;

  std::size_t left() const;

  std::string_view message_;
  std::unique_ptr<Stream> stream_;
};

}  // namespace waymark::importers
