// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
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

/// What a decoder throws at bytes that no encoder writes, and at their end.
struct DamagedChunk {};

/// Decodes adaptive arithmetic coding (Said 2004, 32-bit, byte by byte), as LAZ uses it.
class ArithmeticDecoder {
 public:
  ArithmeticDecoder() = default;
  /// Throws DamagedChunk if there are fewer than four bytes.
  explicit ArithmeticDecoder(std::span<const unsigned char> bytes)
      : begin_(bytes.data()), next_(bytes.data()), end_(bytes.data() + bytes.size()) {
    for (int i = 0; i < 4; ++i) value_ = value_ << 8 | next_byte();
  }

  unsigned symbol(SymbolModel& model) {
    const std::uint32_t step = range_ >> 15;
    const std::uint32_t at = std::min<std::uint32_t>(value_ / step, 32767);
    const std::uint16_t* starts = model.starts();
    unsigned s = model.guess(at);
    while (starts[s + 1] <= at) ++s;
    const std::uint32_t low = starts[s] * step;
    const std::uint32_t high = s + 1 == model.symbols() ? range_ : starts[s + 1] * step;
    narrow(low, high);
    model.count(s);
    return s;
  }

  unsigned bit(BitModel& model) {
    const std::uint32_t middle = model.probability_of_0() * (range_ >> 13);
    const unsigned bit = value_ >= middle ? 1 : 0;
    bit == 0 ? narrow(0, middle) : narrow(middle, range_);
    model.count(bit);
    return bit;
  }

  /// Reads 1 to 32 equally probable bits; more than 19 come as 16 low and then the high ones.
  std::uint32_t bits(unsigned count) {
    if (count > 19) {
      const std::uint32_t low = bits(16);
      return low | bits(count - 16) << 16;
    }
    range_ >>= count;
    const std::uint32_t all = value_ / range_;
    if (all >> count != 0) throw DamagedChunk{};
    value_ -= all * range_;
    refill();
    return all;
  }

  /// Returns the number of bytes that were read.
  std::size_t consumed() const { return static_cast<std::size_t>(next_ - begin_); }

 private:
  void narrow(std::uint32_t low, std::uint32_t high) {
    value_ -= low;
    range_ = high - low;
    refill();
  }
  void refill() {
    while (range_ < 1U << 24) {
      value_ = value_ << 8 | next_byte();
      range_ <<= 8;
    }
  }
  unsigned char next_byte() {
    if (next_ == end_) throw DamagedChunk{};
    return *next_++;
  }

  const unsigned char *begin_ = nullptr, *next_ = nullptr, *end_ = nullptr;
  std::uint32_t value_ = 0, range_ = 0xFFFFFFFF;
};

}  // namespace waymark::importers
