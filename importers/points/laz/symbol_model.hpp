// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
namespace waymark::importers {

/// Adaptive frequencies of an alphabet for arithmetic coding (Said 2004), as LAZ defines them: probabilities
/// of 15 bits, recomputed after ever more symbols. Every symbol keeps a probability above zero.
class SymbolModel {
 public:
  /// Makes a model that must be reset before use.
  SymbolModel() = default;
  /// Takes 2 to 2048 symbols.
  explicit SymbolModel(unsigned symbols) { reset(symbols); }

  /// Makes all symbols equally probable.
  void reset(unsigned symbols);
  bool ready() const { return symbols_ > 0; }
  unsigned symbols() const { return symbols_; }

  /// Returns the cumulative frequency below each symbol, in 1/32768; that of `symbols()` is 32768.
  const std::uint16_t* starts() const { return cells_.data(); }
  /// Returns a symbol at or below the one whose interval holds `at`, 0 to 32767.
  unsigned guess(std::uint32_t at) const { return cells_[2 * symbols_ + 1 + (at >> shift_)]; }

  void count(unsigned symbol) {
    ++cells_[symbols_ + 1 + symbol];
    if (--left_ == 0) adapt();
  }

 private:
  void adapt();
  void recompute();

  unsigned symbols_ = 0, shift_ = 0;
  std::uint32_t total_ = 0, cycle_ = 0, left_ = 0;
  std::vector<std::uint16_t> cells_;  // starts, counts, guesses
};

/// The same for the two symbols 0 and 1, with probabilities of 13 bits.
class BitModel {
 public:
  std::uint32_t probability_of_0() const { return probability_; }
  void count(unsigned bit) {
    zeros_ += 1 - bit;
    if (--left_ == 0) adapt();
  }

 private:
  void adapt();

  std::uint32_t probability_ = 1U << 12, zeros_ = 1, total_ = 2, cycle_ = 4, left_ = 4;
};

}  // namespace waymark::importers
