// SPDX-License-Identifier: Apache-2.0
#include "importers/points/laz/gps_time_decoder.hpp"

#include <cstring>

namespace waymark::importers {
namespace {

// Symbols: 0 no multiple; 1 to 500 that multiple; 501 to 510 the negative ones to -10; 511 no change;
// 512 a time in full; 513 to 515 another sequence.
constexpr int kMaxMultiple = 500, kMinMultiple = -10, kSame = 511, kInFull = 512, kMaxUnusual = 3;
constexpr int kMaxSwitches = 4;  // encoders choose a sequence once

std::int32_t product(int factor, std::int32_t step) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(factor) * static_cast<std::uint32_t>(step));
}

}  // namespace

GpsTimeDecoder::GpsTimeDecoder(const unsigned char* first) {
  std::memcpy(&sequences_[0].time, first, sizeof sequences_[0].time);
}

void GpsTimeDecoder::next(ArithmeticDecoder& from) {
  for (int switches = 0; now().step == 0 ? next_after_no_step(from) : next_after_step(from); ++switches)
    if (switches > kMaxSwitches) throw DamagedChunk{};
}

bool GpsTimeDecoder::next_after_no_step(ArithmeticDecoder& from) {
  const unsigned symbol = from.symbol(starts_);
  if (symbol == 1) {
    now().step = steps_.next(from, 0, 0);
    now().unusual = 0;
    advance(now().step);
  }
  if (symbol == 2) read_whole(from);
  if (symbol <= 2) return false;
  current_ = (current_ + symbol - 2) & 3U;
  return true;
}

bool GpsTimeDecoder::next_after_step(ArithmeticDecoder& from) {
  const auto symbol = static_cast<int>(from.symbol(multiples_));
  if (symbol == 1) {
    advance(steps_.next(from, now().step, 1));
    now().unusual = 0;
  } else if (symbol < kSame) {
    advance(multiple(from, symbol));
  } else if (symbol == kInFull) {
    read_whole(from);
  } else if (symbol > kInFull) {
    current_ = (current_ + static_cast<unsigned>(symbol - kInFull)) & 3U;
    return true;
  }
  return false;
}

std::int32_t GpsTimeDecoder::multiple(ArithmeticDecoder& from, int symbol) {
  const int factor = symbol <= kMaxMultiple ? symbol : kMaxMultiple - symbol;
  const unsigned context = factor == 0              ? 7
                           : factor == kMaxMultiple ? 4
                           : factor >= 10           ? 3
                           : factor > 0             ? 2
                           : factor > kMinMultiple  ? 5
                                                    : 6;
  const std::int32_t step = steps_.next(from, product(factor, now().step), context);
  const bool extreme = factor == 0 || factor == kMaxMultiple || factor == kMinMultiple;
  if (extreme && ++now().unusual > kMaxUnusual) {
    now().step = step;
    now().unusual = 0;
  }
  return step;
}

void GpsTimeDecoder::read_whole(ArithmeticDecoder& from) {
  const auto upper = static_cast<std::int32_t>(now().time >> 32);
  newest_ = (newest_ + 1) & 3U;
  const auto high = static_cast<std::uint32_t>(steps_.next(from, upper, 8));
  const std::uint32_t low = from.bits(32);
  current_ = newest_;
  now() = {std::uint64_t{high} << 32 | low, 0, 0};
}

}  // namespace waymark::importers
