// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
namespace waymark::importers {

/// How a number is stored in a field of a point.
struct NumberType {
  std::size_t size = 0;  ///< bytes: 1, 2 or 4; 4 or 8 if real
  bool is_real = false, is_signed = false;
};

/// Reads the number at `from`. `swapped`: its bytes are in the order that this machine, little-endian, has
/// not.
double read_binary_number(const char* from, const NumberType& type, bool swapped);

}  // namespace waymark::importers
