// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include "importers/points/laz/integer_decoder.hpp"
namespace waymark::importers {

/// Follows the GPS times of point formats 1 to 5, as far as the position in the stream depends on them. Up
/// to four sequences of times are interleaved; in each, a step is coded as a multiple of the last usual one.
class GpsTimeDecoder {
 public:
  /// Takes the 8 bytes of the first time.
  explicit GpsTimeDecoder(const unsigned char* first);
  void next(ArithmeticDecoder& from);

 private:
  struct Sequence {
    std::uint64_t time = 0;  // the bits of the double
    std::int32_t step = 0;
    int unusual = 0;  // steps in succession that are no multiple of `step`
  };
  // Both return whether the symbol only chose another sequence.
  bool next_after_no_step(ArithmeticDecoder& from);
  bool next_after_step(ArithmeticDecoder& from);
  std::int32_t multiple(ArithmeticDecoder& from, int symbol);
  void read_whole(ArithmeticDecoder& from);
  void advance(std::int32_t step) { now().time += static_cast<std::uint64_t>(std::int64_t{step}); }
  Sequence& now() { return sequences_[current_]; }

  std::array<Sequence, 4> sequences_{};
  unsigned current_ = 0, newest_ = 0;
  SymbolModel multiples_{516}, starts_{6};
  IntegerDecoder steps_{32, 9};
};

}  // namespace waymark::importers
