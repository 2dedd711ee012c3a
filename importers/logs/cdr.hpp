// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>
namespace waymark::importers {

/// Reads values of a message in the Common Data Representation (OMG DDSI-RTPS 2.3, section 10), as ROS 2
/// writes it: four bytes name the byte order, then each number is aligned to its size. Throws
/// std::runtime_error if the bytes end too early or have another encapsulation; reserves no more than the
/// message holds.
class CdrReader {
 public:
  explicit CdrReader(std::string_view message) {
    if (message.size() < 4) throw std::runtime_error("the message ends too early");
    if (message[0] != 0 || (message[1] != 0 && message[1] != 1))
      throw std::runtime_error("the message is not plain CDR");
    swapped_ = message[1] == 0;
    bytes_ = message.substr(4);
  }

  template <class T>
  requires std::is_arithmetic_v<T> T number() {
    align(sizeof(T));
    char raw[sizeof(T)];
    std::memcpy(raw, take(sizeof(T)), sizeof(T));
    if (swapped_) std::reverse(raw, raw + sizeof(T));
    T value;
    std::memcpy(&value, raw, sizeof(T));
    return value;
  }

  std::string text() {
    const std::size_t size = number<std::uint32_t>();  // with the final zero
    std::string_view all(take(size), size);
    if (all.ends_with('\0')) all.remove_suffix(1);
    return std::string(all);
  }

  /// Reads the length of a sequence whose items take at least `item_size` bytes.
  std::size_t count(std::size_t item_size) {
    const std::size_t n = number<std::uint32_t>();
    if (n > (bytes_.size() - at_) / item_size) throw std::runtime_error("the message ends too early");
    return n;
  }

  /// Returns the next `size` bytes of the message.
  std::string_view bytes(std::size_t size) { return {take(size), size}; }

  std::vector<float> floats() {
    std::vector<float> all(count(sizeof(float)));
    for (float& value : all) value = number<float>();
    return all;
  }

 private:
  void align(std::size_t size) { take((size - at_ % size) % size); }
  const char* take(std::size_t size) {
    if (size > bytes_.size() - at_) throw std::runtime_error("the message ends too early");
    const char* first = bytes_.data() + at_;
    at_ += size;
    return first;
  }

  static_assert(std::endian::native == std::endian::little);
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool swapped_ = false;
};

}  // namespace waymark::importers
