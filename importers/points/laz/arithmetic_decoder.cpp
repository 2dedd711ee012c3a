// SPDX-License-Identifier: Apache-2.0
#include "importers/points/laz/arithmetic_decoder.hpp"

#include <algorithm>
#include <bit>

namespace waymark::importers {
namespace {

constexpr std::uint32_t kWhole = 1U << 31;
constexpr unsigned kSymbolBits = 15, kBitBits = 13;

}  // namespace

void SymbolModel::reset(unsigned symbols) {
  symbols_ = symbols;
  // A guess for about every second symbol: the search from there takes a step or two.
  const auto bits = static_cast<unsigned>(std::max(2, static_cast<int>(std::bit_width(symbols - 1)) - 1));
  shift_ = kSymbolBits - bits;
  cells_.assign(2 * std::size_t{symbols} + 1 + (std::size_t{1} << bits), 1);
  total_ = symbols;
  recompute();
  cycle_ = left_ = (symbols + 6) / 2;
}

void SymbolModel::adapt() {
  std::uint16_t* counts = cells_.data() + symbols_ + 1;
  total_ += cycle_;
  if (total_ > 1U << kSymbolBits) {
    total_ = 0;
    for (unsigned s = 0; s < symbols_; ++s) {
      counts[s] = static_cast<std::uint16_t>((counts[s] + 1U) / 2);
      total_ += counts[s];
    }
  }
  recompute();
  cycle_ = left_ = std::min(5 * cycle_ / 4, (symbols_ + 6) * 8);
}

void SymbolModel::recompute() {
  std::uint16_t* starts = cells_.data();
  const std::uint16_t* counts = starts + symbols_ + 1;
  std::uint16_t* guesses = starts + 2 * symbols_ + 1;
  const std::uint32_t scale = kWhole / total_;
  std::uint32_t sum = 0;
  unsigned next = 0;  // guess to be set
  for (unsigned s = 0; s < symbols_; ++s) {
    starts[s] = static_cast<std::uint16_t>((scale * sum) >> (31 - kSymbolBits));
    sum += counts[s];
    for (; next << shift_ < starts[s]; ++next) guesses[next] = static_cast<std::uint16_t>(s - 1);
  }
  starts[symbols_] = 1U << kSymbolBits;
  for (; next < 1U << (kSymbolBits - shift_); ++next)
    guesses[next] = static_cast<std::uint16_t>(symbols_ - 1);
}

void BitModel::adapt() {
  total_ += cycle_;
  if (total_ > 1U << kBitBits) {
    total_ = (total_ + 1) / 2;
    zeros_ = (zeros_ + 1) / 2;
    if (zeros_ == total_) ++total_;
  }
  probability_ = (zeros_ * (kWhole / total_)) >> (31 - kBitBits);
  cycle_ = left_ = std::min(5 * cycle_ / 4, std::uint32_t{64});
}

}  // namespace waymark::importers
