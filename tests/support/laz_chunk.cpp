// SPDX-License-Identifier: Apache-2.0
// Writes chunks of LAZ for tests of the reader: a slow twin that follows the description of the format.
#include "tests/support/laz_chunk.hpp"

#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>

#include "importers/points/laz/return_context.hpp"
#include "importers/points/laz/running_median.hpp"
#include "tests/support/arithmetic_encoder.hpp"

namespace waymark::test {
namespace {

using importers::even_context;
using importers::return_context16;
using importers::return_context8;
using importers::return_level;
using importers::RunningMedian;

std::int32_t wrapped_difference(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}

// Encodes x, y and z of a return by the steps before and the heights of its level.
struct Coordinates {
  IntegerEncoder x{32, 2}, y{32, 22}, z{32, 20};
  std::array<std::map<unsigned, RunningMedian>, 2> medians;
  std::array<std::int32_t, 8> heights{};

  void put(ArithmeticEncoder& xy, ArithmeticEncoder& into_z, const RawPoint& last, const RawPoint& p,
           unsigned context) {
    const unsigned single = p.returns == 1 ? 1 : 0, level = return_level(p.returns, p.number);
    std::array<std::int32_t, 2> step{};
    for (const std::size_t axis : {0, 1}) step[axis] = wrapped_difference(p.at[axis], last.at[axis]);
    x.put(xy, medians[0][context].get(), step[0], single);
    y.put(xy, medians[1][context].get(), step[1], single + even_context(x.magnitude(), 20));
    for (const std::size_t axis : {0, 1}) medians[axis][context].add(step[axis]);
    const unsigned bits = (x.magnitude() + y.magnitude()) / 2;
    z.put(into_z, heights[level], p.at[2], single + even_context(bits, 18));
    heights[level] = p.at[2];
  }
};

struct Times {
  std::int64_t time;
  std::int32_t step = 0;
  int unusual = 0;
  SlowModel multiples{516}, starts{6};
  IntegerEncoder steps{32, 9};

  void put(ArithmeticEncoder& into, std::int64_t next) {
    const auto wide =  // modulo 2^64, as readers add it
        static_cast<std::int64_t>(static_cast<std::uint64_t>(next) - static_cast<std::uint64_t>(time));
    const auto change = static_cast<std::int32_t>(wide);
    if (change != wide) {
      step == 0 ? into.symbol(starts, 2) : into.symbol(multiples, 512);
      steps.put(into, static_cast<std::int32_t>(time >> 32), static_cast<std::int32_t>(next >> 32), 8);
      into.bits(32, static_cast<std::uint32_t>(next));
      step = unusual = 0;
    } else if (step == 0) {
      into.symbol(starts, change == 0 ? 0 : 1);
      if (change != 0) steps.put(into, 0, step = change, 0), unusual = 0;
    } else if (change == 0) {
      into.symbol(multiples, 511);
    } else {
      put_multiple(into, change);
    }
    time = next;
  }
  void put_multiple(ArithmeticEncoder& into, std::int32_t change) {
    const int factor = static_cast<int>(std::clamp<std::int64_t>(std::int64_t{change} / step, -10, 500));
    into.symbol(multiples, static_cast<unsigned>(factor < 0 ? 500 - factor : factor));
    const std::size_t context = factor == 0     ? 7
                                : factor == 1   ? 1
                                : factor == 500 ? 4
                                : factor >= 10  ? 3
                                : factor > 0    ? 2
                                : factor > -10  ? 5
                                                : 6;
    const auto predicted =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(factor) * static_cast<std::uint32_t>(step));
    steps.put(into, predicted, change, context);
    if (factor == 1) unusual = 0;
    if ((factor == 0 || factor == 500 || factor == -10) && ++unusual > 3) step = change, unusual = 0;
  }
};

unsigned char byte14(const RawPoint& p) {
  return static_cast<unsigned char>(p.number | p.returns << 3 | (p.flags >> 4) << 6);
}
unsigned char byte15(const RawPoint& p) {
  return static_cast<unsigned char>((p.classification & 31) | (p.flags & 7) << 5);
}

SlowModel& model_after(std::map<unsigned, SlowModel>& models, unsigned last, std::size_t symbols) {
  return models.try_emplace(last, symbols).first->second;
}

std::string pointwise_chunk(std::span<const RawPoint> points, int format, int extra_bytes) {
  std::string bytes = las_record(points[0], format, extra_bytes);
  if (points.size() < 2) return bytes;
  ArithmeticEncoder into;
  Coordinates coordinates;
  SlowModel changes(64), rgb_changes(128), index(256), offset_kind(4);
  std::map<unsigned, SlowModel> flags, classes, user_data, angles, rgb, extra;
  IntegerEncoder intensity(16, 4), source(16), size(32), return_point(32), direction(32, 3);
  std::array<std::uint16_t, 16> intensities{};
  Times times{points[0].time};
  for (std::size_t i = 1; i < points.size(); ++i) {
    const RawPoint &last = points[i - 1], &p = points[i];
    const unsigned context = return_context8(p.returns, p.number);
    unsigned changed = 0;
    if (byte14(p) != byte14(last)) changed |= 32;
    if (p.intensity != intensities[context]) changed |= 16;
    if (byte15(p) != byte15(last)) changed |= 8;
    if (p.angle != last.angle) changed |= 4;
    if (p.user_data != last.user_data) changed |= 2;
    if (p.source != last.source) changed |= 1;
    into.symbol(changes, changed);
    if (changed & 32) into.symbol(model_after(flags, byte14(last), 256), byte14(p));
    if (changed & 16) intensity.put(into, intensities[context], p.intensity, std::min(context, 3U));
    intensities[context] = p.intensity;
    if (changed & 8) into.symbol(model_after(classes, byte15(last), 256), byte15(p));
    if (changed & 4)
      into.symbol(model_after(angles, (p.flags >> 4) & 1, 256),
                  static_cast<unsigned char>(p.angle - last.angle));
    if (changed & 2) into.symbol(model_after(user_data, last.user_data, 256), p.user_data);
    if (changed & 1) source.put(into, last.source, p.source);
    coordinates.put(into, into, last, p, context);
    if (format != 0 && format != 2) times.put(into, p.time);
    if (format == 2 || format == 3 || format == 5) {
      const unsigned colours = p.colour[0] % 128;  // any set of changed bytes
      into.symbol(rgb_changes, colours);
      for (const unsigned b : {0U, 1U, 2U, 4U, 3U, 5U})
        if ((colours >> b & 1) != 0 && (b < 2 || colours >= 64))
          into.symbol(model_after(rgb, b, 256), p.colour[1] & 255);
    }
    if (format == 4 || format == 5) {
      into.symbol(index, 1);
      into.symbol(offset_kind, 0);
      size.put(into, 0, p.intensity);
      return_point.put(into, 0, p.at[0]);
      for (const std::size_t axis : {0, 1, 2}) direction.put(into, 0, p.at[axis], axis);
    }
    for (int b = 0; b < extra_bytes; ++b)
      into.symbol(model_after(extra, static_cast<unsigned>(b), 256), p.user_data);
  }
  return bytes + into.finish();
}

struct ChannelWriter {
  RawPoint last;
  bool new_time = false;
  Coordinates coordinates;
  std::map<unsigned, SlowModel> changes, returns, number, classes, flags;
  SlowModel other{3}, same_time{13};

  explicit ChannelWriter(const RawPoint& from) : last(from) { coordinates.heights.fill(from.at[2]); }
};

std::string layered_chunk(std::span<const RawPoint> points, int format, int extra_bytes) {
  ArithmeticEncoder position, z, classes, flags;
  std::map<unsigned, ChannelWriter> channels;
  unsigned now = points[0].channel;
  channels.try_emplace(now, points[0]);
  for (const RawPoint& p : points.subspan(1)) {
    ChannelWriter& before = channels.at(now);
    const unsigned context = (before.last.number == 1 ? 1U : 0U) +
                             (before.last.number >= before.last.returns ? 2U : 0U) +
                             (before.new_time ? 4U : 0U);
    const bool new_channel = p.channel != now;
    ChannelWriter& w = channels.try_emplace(p.channel, before.last).first->second;
    const bool new_time = p.time != w.last.time;
    const unsigned up = (p.number + 16U - w.last.number) % 16;
    unsigned changed = up == 0 ? 0 : up == 1 ? 1 : up == 15 ? 2 : 3;
    changed |= (p.returns != w.last.returns ? 4U : 0U) | (p.angle != w.last.angle ? 8U : 0U) |
               (new_time ? 16U : 0U) | (p.source != w.last.source ? 32U : 0U) | (new_channel ? 64U : 0U);
    position.symbol(model_after(before.changes, context, 128), changed);
    if (new_channel) position.symbol(before.other, (p.channel + 4U - now - 1) % 4);
    now = p.channel;
    if (changed & 4) position.symbol(model_after(w.returns, w.last.returns, 16), p.returns);
    if ((changed & 3) == 3)
      new_time ? position.symbol(model_after(w.number, w.last.number, 16), p.number)
               : position.symbol(w.same_time, up - 2);
    w.coordinates.put(position, z, w.last, p, 2 * return_context16(p.returns, p.number) + (new_time ? 1 : 0));
    const bool single = p.number == 1 && p.number >= p.returns;
    classes.symbol(model_after(w.classes, 2U * (w.last.classification & 31U) + (single ? 1 : 0), 256),
                   p.classification);
    flags.symbol(model_after(w.flags, w.last.flags, 64), p.flags);
    w.last = p;
    w.new_time = new_time;
  }
  std::vector<std::string> layers{position.finish(), z.finish(), classes.finish(), flags.finish()};
  const auto unused = static_cast<std::size_t>(5 + (format == 7) + 2 * (format == 8 || format == 10) +
                                               (format >= 9) + extra_bytes);
  for (std::size_t i = 0; i < unused; ++i) layers.emplace_back(i % 3 * 5, '\x5A');
  // A layer that never changes may be left out.
  const auto same = [&](auto member) {
    return std::ranges::all_of(points, [&](const RawPoint& p) { return p.*member == points[0].*member; });
  };
  if (same(&RawPoint::classification)) layers[2].clear();
  if (same(&RawPoint::flags)) layers[3].clear();
  std::string bytes = las_record(points[0], format, extra_bytes);
  const auto put = [&](std::size_t number) {
    const auto n = static_cast<std::uint32_t>(number);
    bytes.append(reinterpret_cast<const char*>(&n), sizeof n);
  };
  put(points.size());
  for (const std::string& layer : layers) put(layer.size());
  for (const std::string& layer : layers) bytes += layer;
  return bytes;
}

}  // namespace

std::string laz_chunk(std::span<const RawPoint> points, int format, int extra_bytes) {
  return format >= 6 ? layered_chunk(points, format, extra_bytes)
                     : pointwise_chunk(points, format, extra_bytes);
}

std::string laz_table(const std::vector<std::uint32_t>& bytes, const std::vector<std::uint32_t>& points,
                      bool variable) {
  ArithmeticEncoder into;
  IntegerEncoder numbers(32, 2);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (variable) numbers.put(into, i > 0 ? points[i - 1] : 0, points[i], 0);
    numbers.put(into, i > 0 ? bytes[i - 1] : 0, bytes[i], 1);
  }
  return into.finish();
}

}  // namespace waymark::test
