// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <vector>
#include "importers/points/laz/arithmetic_decoder.hpp"
namespace waymark::importers {

/// Decodes integers as corrections of predictions: first the number of bits of the correction, whose
/// frequencies depend on a context, then the correction within 2^bits values.
class IntegerDecoder {
 public:
  /// Takes integers of 1 to 32 bits.
  explicit IntegerDecoder(unsigned bits, unsigned contexts = 1)
      : bits_(bits), magnitudes_(contexts), corrections_(bits + 1) {}

  std::int32_t correction(ArithmeticDecoder& from, unsigned context = 0) {
    SymbolModel& magnitudes = magnitudes_[context];
    if (!magnitudes.ready()) magnitudes.reset(bits_ + 1);
    magnitude_ = from.symbol(magnitudes);
    if (magnitude_ == 0) return static_cast<std::int32_t>(from.bit(zero_or_one_));
    if (magnitude_ == 32) return std::numeric_limits<std::int32_t>::min();
    // The upper 8 bits have frequencies, the lower ones are equally probable.
    const unsigned k = magnitude_, upper = std::min(k, 8U), lower = k - upper;
    SymbolModel& corrections = corrections_[k];
    if (!corrections.ready()) corrections.reset(1U << upper);
    std::uint32_t c = from.symbol(corrections);
    if (lower > 0) c = c << lower | from.bits(lower);
    // 2^k values: those below -(2^(k-1) - 1) and above 2^(k-1), since the others have fewer bits.
    const auto whole = std::uint32_t{1} << k;
    return static_cast<std::int32_t>(c >= whole / 2 ? c + 1 : c - (whole - 1));
  }

  /// Returns a 32-bit integer; sums wrap around.
  std::int32_t next(ArithmeticDecoder& from, std::int32_t predicted, unsigned context = 0) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(predicted) +
                                     static_cast<std::uint32_t>(correction(from, context)));
  }

  /// Returns the number of bits of the last correction.
  unsigned magnitude() const { return magnitude_; }

 private:
  unsigned bits_, magnitude_ = 0;
  std::vector<SymbolModel> magnitudes_, corrections_;
  BitModel zero_or_one_;
};

}  // namespace waymark::importers
