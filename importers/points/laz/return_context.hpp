// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>
namespace waymark::importers {

// Constants of the format: contexts of a return by the number of returns of its pulse and its own number.

/// Point formats 0 to 5; hexadecimal.
inline constexpr std::string_view kReturnContext8[8] = {"fedcba98", "e0136aa9", "d1247bba", "c3458ccb",
                                                        "b6789ddc", "aabcdeed", "9abcdefe", "89abcdef"};

/// Point formats 6 to 10.
inline constexpr std::string_view kReturnContext16[16] = {
    "0123453445555555", "1013333333333333", "2124444444443333", "3345444444444444",
    "4344544444444444", "5344454444444444", "3344445444444444", "4344444544444444",
    "4344444454444444", "5344444445444444", "5344444444544444", "5334444444455444",
    "5334444444455544", "5334444444445554", "5334444444444555", "5334444444444455"};

/// Returns 0 to 15; `returns` and `number` are below 8.
inline unsigned return_context8(unsigned returns, unsigned number) {
  const char digit = kReturnContext8[returns][number];
  return static_cast<unsigned>(digit >= 'a' ? digit - 'a' + 10 : digit - '0');
}

/// Returns 0 to 5; `returns` and `number` are below 16.
inline unsigned return_context16(unsigned returns, unsigned number) {
  return static_cast<unsigned>(kReturnContext16[returns][number] - '0');
}

/// Returns how far a return is from the last one of its pulse, 7 at most.
inline unsigned return_level(unsigned returns, unsigned number) {
  const unsigned level = returns > number ? returns - number : number - returns;
  return level < 7 ? level : 7;
}

/// Returns the context of a coordinate by the bits of the previous ones, even and at most `max_context`.
inline unsigned even_context(unsigned bits, unsigned max_context) {
  return bits < max_context ? bits & ~1U : max_context;
}

}  // namespace waymark::importers
