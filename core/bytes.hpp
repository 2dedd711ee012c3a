// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>
namespace waymark::inline core {

static_assert(std::endian::native == std::endian::little, "artifacts are little-endian");

/// Value whose bytes contain no address.
template <class T>
concept Plain = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>;

/// Serializes plain values; each sequence is preceded by its length. Values are written as they lie in
/// memory. Write a struct with padding member by member: padding bytes are undefined.
class ByteWriter {
 public:
  template <Plain T>
  void operator()(const T& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void operator()(const std::string& text) {
    (*this)(static_cast<std::uint64_t>(text.size()));
    bytes_.append(text);
  }
  template <Plain T>
  void operator()(const std::vector<T>& values) {
    (*this)(static_cast<std::uint64_t>(values.size()));
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Reads the output of a ByteWriter. Throws std::runtime_error if the bytes end too early.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  template <Plain T>
  void operator()(T& value) {
    std::memcpy(&value, take(sizeof value), sizeof value);
  }
  void operator()(std::string& text) {
    const std::size_t size = length(1);
    text.assign(take(size), size);
  }
  template <Plain T>
  void operator()(std::vector<T>& values) {
    const std::size_t size = length(sizeof(T));
    values.resize(size);
    if (size) std::memcpy(values.data(), take(size * sizeof(T)), size * sizeof(T));
  }
  template <Plain T>
  T get() {
    T value{};
    (*this)(value);
    return value;
  }
  /// Reads the length of a sequence of items of at least `item_size` bytes. Throws std::runtime_error if the
  /// remaining bytes cannot contain it.
  std::size_t length(std::size_t item_size) {
    const auto size = get<std::uint64_t>();
    if (size > bytes_.size() / item_size) throw std::runtime_error("artifact ends too early");
    return static_cast<std::size_t>(size);
  }
  bool at_end() const { return bytes_.empty(); }
  void expect_end() const {
    if (!bytes_.empty())
      throw std::runtime_error("artifact has " + std::to_string(bytes_.size()) + " bytes too many");
  }

 private:
  const char* take(std::size_t size) {
    if (size > bytes_.size()) throw std::runtime_error("artifact ends too early");
    const char* first = bytes_.data();
    bytes_.remove_prefix(size);
    return first;
  }
  std::string_view bytes_;
};

}  // namespace waymark::inline core
