// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include "core/bytes.hpp"
namespace waymark::inline core {

/// Layout of a value that serves both directions: `Io` is a ByteWriter, and the values are const, or a
/// ByteReader. Structs are written member by member.
template <class Io>
class ByteLayout {
 public:
  static constexpr bool reads = std::is_same_v<Io, ByteReader>;

  explicit ByteLayout(Io& io) : io_(io) {}

  /// Numbers, enumerators, strings, and vectors of numbers.
  template <class... Values>
  void operator()(Values&&... values) {
    (io_(values), ...);
  }
  /// Reads or writes a matrix of Eigen, of fixed or dynamic size. Throws std::runtime_error for another fixed
  /// size.
  void matrix(auto& matrix) {
    std::int64_t rows = matrix.rows(), columns = matrix.cols();
    io_(rows), io_(columns);
    if constexpr (reads) {
      if (rows < 0 || columns < 0) throw std::runtime_error("artifact has a matrix of negative size");
      if constexpr (std::remove_cvref_t<decltype(matrix)>::SizeAtCompileTime == -1)
        matrix.resize(rows, columns);
      if (matrix.rows() != rows || matrix.cols() != columns)
        throw std::runtime_error("artifact has a matrix of another size");
    }
    for (std::int64_t c = 0; c < columns; ++c)
      for (std::int64_t r = 0; r < rows; ++r) io_(matrix(r, c));
  }
  /// Vector, or a span to be written, whose items `each` lays out.
  template <class Items, class Each>
  void list(Items&& items, const Each& each) {
    if constexpr (reads)
      items.resize(io_.length(1));
    else
      io_(static_cast<std::uint64_t>(items.size()));
    for (auto& item : items) each(item);
  }
  /// Optional value.
  template <class Optional, class Each>
  void maybe(Optional& value, const Each& each) {
    if constexpr (reads) {
      if (io_.template get<bool>()) value.emplace();
    } else {
      io_(value.has_value());
    }
    if (value) each(*value);
  }

 private:
  Io& io_;
};

/// Returns the bytes of a value: `layout(io, value)` lays it out.
template <class T, class Layout>
std::string bytes_of(const T& value, const Layout& layout) {
  ByteWriter out;
  ByteLayout<ByteWriter> io(out);
  layout(io, value);
  return out.take();
}

/// Returns the value of bytes. Throws std::runtime_error if they end too early or late.
template <class T, class Layout>
T value_of(std::string_view bytes, const Layout& layout) {
  ByteReader in(bytes);
  ByteLayout<ByteReader> io(in);
  T value{};
  layout(io, value);
  in.expect_end();
  return value;
}

}  // namespace waymark::inline core
