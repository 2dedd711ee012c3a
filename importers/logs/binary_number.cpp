// SPDX-License-Identifier: Apache-2.0
#include "importers/logs/binary_number.hpp"

#include <bit>
#include <cstdint>
#include <cstring>

namespace waymark::importers {

static_assert(std::endian::native == std::endian::little);

double read_binary_number(const char* from, const NumberType& type, bool swapped) {
  unsigned char raw[8] = {};
  for (std::size_t i = 0; i < type.size; ++i)
    raw[i] = static_cast<unsigned char>(from[swapped ? type.size - 1 - i : i]);
  if (type.is_real && type.size == 4) {
    float value;
    std::memcpy(&value, raw, sizeof value);
    return static_cast<double>(value);
  }
  if (type.is_real) {
    double value;
    std::memcpy(&value, raw, sizeof value);
    return value;
  }
  std::int64_t value = 0;
  for (std::size_t i = 0; i < type.size; ++i) value |= std::int64_t{raw[i]} << (8 * i);
  if (type.is_signed && (raw[type.size - 1] & 0x80) != 0) value -= std::int64_t{1} << (8 * type.size);
  return static_cast<double>(value);
}

}  // namespace waymark::importers
