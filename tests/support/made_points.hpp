// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <random>
#include <type_traits>
#include <vector>
#include "tests/support/laz_writer.hpp"
namespace waymark::test {

/// Returns returns of pulses along scan lines with trees, and now and then a wild value in any field.
inline std::vector<RawPoint> made_points(unsigned seed, std::size_t count, int format, double wild = 0.01) {
  std::mt19937 random(seed);
  const auto below = [&](std::uint32_t bound) { return static_cast<int>(random() % bound); };
  // Sums of wild values wrap around.
  const auto wrapped = [](auto value, std::int64_t more) {
    using Unsigned = std::make_unsigned_t<decltype(value)>;
    return static_cast<decltype(value)>(static_cast<Unsigned>(value) + static_cast<Unsigned>(more));
  };
  const bool layered = format >= 6;
  std::vector<RawPoint> points;
  RawPoint p;
  p.time = 0x41E0000000000000;
  int left = 0;
  while (points.size() < count) {
    if (left == 0) {
      left = 1 + (below(4) == 0 ? below(layered ? 15 : 5) : 0);
      p.returns = static_cast<std::uint8_t>(left), p.number = 0;
      p.time = wrapped(p.time, 4000 + below(3));
      p.channel = static_cast<std::uint8_t>(layered && below(3) == 0 ? below(4) : p.channel);
      p.at[0] = wrapped(p.at[0], 400 + below(20)), p.at[1] = wrapped(p.at[1], below(40) - 20);
      if (below(60) == 0) p.at[0] = wrapped(p.at[0], -60 * 400), p.flags ^= 16;
      p.angle = static_cast<std::int16_t>(p.angle + below(3) - 1);
    }
    --left, ++p.number;
    p.at[2] = 1000 + (p.number < p.returns ? below(12000) : below(50));
    p.classification = static_cast<std::uint8_t>(p.number == p.returns ? 2 : 3 + below(3));
    p.intensity = static_cast<std::uint16_t>(below(200) + 100 * p.number);
    for (std::uint16_t& colour : p.colour) colour = static_cast<std::uint16_t>(random());
    if (below(1000000) < wild * 1e6) {
      for (std::int32_t& c : p.at) c = static_cast<std::int32_t>(random()) >> below(24);
      p.classification = static_cast<std::uint8_t>(below(layered ? 256 : 32));
      p.flags = static_cast<std::uint8_t>(below(64)), p.source = static_cast<std::uint16_t>(random());
      if (!layered) p.flags &= 0x37;
      p.user_data = static_cast<std::uint8_t>(random());
      p.time = wrapped(p.time, static_cast<std::int64_t>(static_cast<std::uint64_t>(random()) << below(30)));
      p.number = static_cast<std::uint8_t>(below(layered ? 16 : 8));
      p.returns = static_cast<std::uint8_t>(below(layered ? 16 : 8));
      left = 0;
    }
    points.push_back(p);
  }
  return points;
}

}  // namespace waymark::test
