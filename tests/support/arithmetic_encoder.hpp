// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>
namespace waymark::test {

/// Adaptive frequencies as LAZ defines them, written to be obvious rather than fast.
struct SlowModel {
  std::uint32_t total = 0, cycle = 0, left = 0;
  std::vector<std::uint32_t> counts, starts;

  explicit SlowModel(std::size_t symbols)
      : total(static_cast<std::uint32_t>(symbols)), counts(symbols, 1), starts(symbols) {
    recompute();
    cycle = left = (total + 6) / 2;
  }
  void recompute() {
    std::uint32_t sum = 0;
    for (std::size_t s = 0; s < counts.size(); sum += counts[s++])
      starts[s] = (0x80000000U / total * sum) >> 16;
  }
  void count(std::size_t symbol) {
    ++counts[symbol];
    if (--left > 0) return;
    total += cycle;
    if (total > 32768) {
      total = 0;
      for (std::uint32_t& c : counts) total += c = (c + 1) / 2;
    }
    recompute();
    cycle = left = std::min<std::uint32_t>(cycle * 5 / 4, static_cast<std::uint32_t>(counts.size() + 6) * 8);
  }
};

struct SlowBitModel {
  std::uint32_t zeros = 1, total = 2, cycle = 4, left = 4, probability = 4096;
  void count(unsigned bit) {
    zeros += 1 - bit;
    if (--left > 0) return;
    total += cycle;
    if (total > 8192) {
      total = (total + 1) / 2;
      zeros = (zeros + 1) / 2;
      if (zeros == total) ++total;
    }
    probability = (0x80000000U / total * zeros) >> 18;
    cycle = left = std::min<std::uint32_t>(cycle * 5 / 4, 64);
  }
};

/// Encodes what ArithmeticDecoder decodes (Said 2004).
class ArithmeticEncoder {
 public:
  void symbol(SlowModel& model, unsigned s) {
    const std::uint32_t step = range_ >> 15;
    const bool last = s + 1 == model.counts.size();
    narrow(model.starts[s] * step, last ? range_ : model.starts[s + 1] * step);
    model.count(s);
  }
  void bit(SlowBitModel& model, unsigned b) {
    const std::uint32_t middle = model.probability * (range_ >> 13);
    b == 0 ? narrow(0, middle) : narrow(middle, range_);
    model.count(b);
  }
  void bits(unsigned count, std::uint32_t value) {
    if (count > 19) {
      bits(16, value & 0xFFFF);
      return bits(count - 16, value >> 16);
    }
    const std::uint32_t step = range_ >> count;
    range_ = step;
    add(value * step);
    emit();
  }
  /// Returns all bytes, as many as the decoder reads.
  std::string finish() {
    const bool another = range_ > 2U << 24;
    add(another ? 1U << 24 : 1U << 23);
    range_ = another ? 1U << 23 : 1U << 15;
    emit();
    return bytes_ + std::string(another ? 3 : 2, '\0');
  }

 private:
  void narrow(std::uint32_t low, std::uint32_t high) {
    add(low);
    range_ = high - low;
    emit();
  }
  void add(std::uint32_t amount) {
    if (base_ + amount < base_)  // carry
      for (std::size_t i = bytes_.size(); i-- > 0;) {
        bytes_[i] = static_cast<char>(bytes_[i] + 1);
        if (bytes_[i] != 0) break;
      }
    base_ += amount;
  }
  void emit() {
    while (range_ < 1U << 24) {
      bytes_ += static_cast<char>(base_ >> 24);
      base_ <<= 8;
      range_ <<= 8;
    }
  }
  std::uint32_t base_ = 0, range_ = 0xFFFFFFFF;
  std::string bytes_;
};

/// Encodes what IntegerDecoder decodes.
class IntegerEncoder {
 public:
  explicit IntegerEncoder(unsigned bits, std::size_t contexts = 1)
      : bits_(bits), magnitudes_(contexts, SlowModel(bits + 1)) {
    for (unsigned k = 0; k <= bits; ++k) corrections_.emplace_back(std::size_t{1} << std::clamp(k, 1U, 8U));
  }

  void put(ArithmeticEncoder& into, std::int64_t predicted, std::int64_t value, std::size_t context = 0) {
    const std::int64_t whole = std::int64_t{1} << bits_;
    std::int64_t c = (value - predicted) % whole;  // to -whole / 2 .. whole / 2 - 1
    if (c >= whole / 2) c -= whole;
    if (c < -whole / 2) c += whole;
    magnitude_ = 0;
    for (std::int64_t rest = c <= 0 ? -c : c - 1; rest > 0; rest /= 2) ++magnitude_;
    into.symbol(magnitudes_[context], magnitude_);
    if (magnitude_ == 0) return into.bit(zero_or_one_, static_cast<unsigned>(c));
    if (magnitude_ == 32) return;
    const auto code = static_cast<std::uint32_t>(c < 0 ? c + (std::int64_t{1} << magnitude_) - 1 : c - 1);
    const unsigned lower = magnitude_ > 8 ? magnitude_ - 8 : 0;
    into.symbol(corrections_[magnitude_], code >> lower);
    if (lower > 0) into.bits(lower, code & ((1U << lower) - 1));
  }
  unsigned magnitude() const { return magnitude_; }

 private:
  unsigned bits_, magnitude_ = 0;
  std::vector<SlowModel> magnitudes_, corrections_;
  SlowBitModel zero_or_one_;
};

}  // namespace waymark::test
