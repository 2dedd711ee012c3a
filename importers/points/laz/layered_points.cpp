// SPDX-License-Identifier: Apache-2.0
#include "importers/points/laz/layered_points.hpp"

#include <array>
#include <cstring>
#include <memory>
#include <optional>

#include "importers/points/laz/integer_decoder.hpp"
#include "importers/points/laz/return_context.hpp"
#include "importers/points/laz/running_median.hpp"

namespace waymark::importers {
namespace {

constexpr std::size_t kRecord = 30, kPointLayers = 9;

std::uint32_t number_of_layer(std::span<const unsigned char> bytes, std::size_t offset) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

// Decoders of the layers in use. A layer without bytes does not change within the chunk.
struct Layers {
  ArithmeticDecoder position;  // channel, returns, x and y
  std::optional<ArithmeticDecoder> z, classification, flags;
};

std::size_t layer_count(const LasHeader& header) {
  std::size_t count = kPointLayers;
  for (const LazItem& item : header.laz->items) {
    if (item.type == LazType::rgb14 || item.type == LazType::wave14) count += 1;
    if (item.type == LazType::rgbnir14) count += 2;
    if (item.type == LazType::bytes14) count += item.size;
  }
  return count;
}

// A chunk is: the first point uncompressed, the number of points, the bytes of each layer, the layers.
Layers layers_of(std::span<const unsigned char> chunk, const LasHeader& header, std::uint64_t count) {
  const auto length = static_cast<std::size_t>(header.point_length);
  const std::size_t layers = layer_count(header), sizes = length + 4;
  if (chunk.size() < sizes + 4 * layers || number_of_layer(chunk, length) != count) throw DamagedChunk{};
  std::array<std::span<const unsigned char>, kPointLayers> parts;
  std::span<const unsigned char> rest = chunk.subspan(sizes + 4 * layers);
  for (std::size_t i = 0; i < layers; ++i) {
    const std::size_t bytes = number_of_layer(chunk, sizes + 4 * i);
    if (bytes > rest.size()) throw DamagedChunk{};
    if (i < parts.size()) parts[i] = rest.first(bytes);
    rest = rest.subspan(bytes);
  }
  const auto decoder = [](std::span<const unsigned char> bytes) {
    return bytes.empty() ? std::nullopt : std::optional<ArithmeticDecoder>(std::in_place, bytes);
  };
  return {ArithmeticDecoder(parts[0]), decoder(parts[1]), decoder(parts[2]), decoder(parts[3])};
}

// Models that depend on the value before; made when they are first needed.
template <std::size_t kContexts>
class ModelsAfter {
 public:
  explicit ModelsAfter(unsigned symbols) : symbols_(symbols) {}
  unsigned next(ArithmeticDecoder& from, std::size_t context) {
    SymbolModel& model = models_[context];
    if (!model.ready()) model.reset(symbols_);
    return from.symbol(model);
  }

 private:
  unsigned symbols_;
  std::array<SymbolModel, kContexts> models_;
};

struct Point14 {
  std::array<std::int32_t, 3> at{};
  unsigned number = 1, returns = 1;  // 0 to 15
  unsigned classification = 0;
  unsigned flags = 0;  // 1 synthetic, 2 key point, 4 withheld, 8 overlap, 16 scan direction, 32 edge
  bool new_time = false;

  explicit Point14(const unsigned char* record)
      : number(record[14] & 15U),
        returns(record[14] >> 4U),
        classification(record[16]),
        flags((record[15] & 15U) | (record[15] >> 6U) << 4U) {
    std::memcpy(at.data(), record, sizeof at);
  }
};

// State of a scanner channel: each has its own models and its own last point.
class Channel {
 public:
  explicit Channel(const Point14& last) : last_(last) {
    last_.new_time = false;
    heights_.fill(last.at[2]);
    for (SymbolModel& model : changes_) model.reset(128);
  }
  const Point14& last() const { return last_; }

  unsigned changes(ArithmeticDecoder& from) {
    const unsigned context = (last_.number == 1 ? 1U : 0U) + (last_.number >= last_.returns ? 2U : 0U) +
                             (last_.new_time ? 4U : 0U);
    return from.symbol(changes_[context]);
  }
  unsigned other_channel(ArithmeticDecoder& from) { return from.symbol(other_channel_); }

  // Bits of `changed`: 1 and 2 return number, 4 number of returns, 16 time.
  const Point14& next(Layers& layers, unsigned changed) {
    last_.new_time = (changed & 16) != 0;
    read_returns(layers.position, changed);
    read_position(layers);
    const bool single = last_.number == 1 && last_.number >= last_.returns;
    if (layers.classification)
      last_.classification =
          class_.next(*layers.classification, 2 * (last_.classification & 31U) + (single ? 1 : 0));
    if (layers.flags) last_.flags = flags_.next(*layers.flags, last_.flags);
    return last_;
  }

 private:
  void read_returns(ArithmeticDecoder& from, unsigned changed) {
    if (changed & 4) last_.returns = returns_.next(from, last_.returns);
    switch (changed & 3) {
      case 0:
        return;
      case 1:
        last_.number = (last_.number + 1) & 15U;
        return;
      case 2:
        last_.number = (last_.number + 15) & 15U;
        return;
      default:
        last_.number = last_.new_time ? number_.next(from, last_.number)
                                      : (last_.number + from.symbol(number_of_same_time_) + 2) & 15U;
    }
  }

  void read_position(Layers& layers) {
    const unsigned context = 2 * return_context16(last_.returns, last_.number) + (last_.new_time ? 1 : 0);
    const unsigned level = return_level(last_.returns, last_.number), single = last_.returns == 1 ? 1 : 0;
    ArithmeticDecoder& from = layers.position;
    move(0, x_.next(from, medians_[0][context].get(), single), context);
    move(1, y_.next(from, medians_[1][context].get(), single + even_context(x_.magnitude(), 20)), context);
    if (!layers.z) return;
    const unsigned bits = (x_.magnitude() + y_.magnitude()) / 2;
    heights_[level] = last_.at[2] = z_.next(*layers.z, heights_[level], single + even_context(bits, 18));
  }

  void move(std::size_t axis, std::int32_t step, unsigned context) {
    last_.at[axis] = static_cast<std::int32_t>(static_cast<std::uint32_t>(last_.at[axis]) +
                                               static_cast<std::uint32_t>(step));
    medians_[axis][context].add(step);
  }

  Point14 last_;
  std::array<SymbolModel, 8> changes_;
  SymbolModel other_channel_{3}, number_of_same_time_{13};
  ModelsAfter<16> returns_{16}, number_{16};
  ModelsAfter<64> class_{256}, flags_{64};
  IntegerDecoder x_{32, 2}, y_{32, 22}, z_{32, 20};
  std::array<std::array<RunningMedian, 12>, 2> medians_;
  std::array<std::int32_t, 8> heights_{};
};

LasPoint las_point(const Point14& point, const LasHeader& header) {
  LasPoint p;
  p.x = header.offset[0] + header.scale[0] * point.at[0];
  p.y = header.offset[1] + header.scale[1] * point.at[1];
  p.z = header.offset[2] + header.scale[2] * point.at[2];
  p.classification = static_cast<std::uint8_t>(point.classification);
  p.return_number = static_cast<std::uint8_t>(point.number);
  p.return_count = static_cast<std::uint8_t>(point.returns);
  p.withheld = (point.flags & 4) != 0;
  return p;
}

}  // namespace

std::vector<LasPoint> layered_points(std::span<const unsigned char> chunk, const LasHeader& header,
                                     std::uint64_t count) {
  std::vector<LasPoint> points;
  if (count == 0) return points;
  if (chunk.size() < static_cast<std::size_t>(header.point_length) || header.point_length < int{kRecord})
    throw DamagedChunk{};
  Layers layers = layers_of(chunk, header, count);
  // A false count must not reserve memory.
  points.reserve(static_cast<std::size_t>(std::min<std::uint64_t>(count, 16 * chunk.size())));
  const Point14 first(chunk.data());
  points.push_back(las_point(first, header));  // not compressed
  std::array<std::unique_ptr<Channel>, 4> channels;
  std::size_t now = chunk[15] >> 4U & 3U;
  channels[now] = std::make_unique<Channel>(first);
  while (points.size() < count) {
    const unsigned changed = channels[now]->changes(layers.position);
    if (changed & 64) {
      const std::size_t other = (now + channels[now]->other_channel(layers.position) + 1) & 3U;
      if (!channels[other]) channels[other] = std::make_unique<Channel>(channels[now]->last());
      now = other;
    }
    points.push_back(las_point(channels[now]->next(layers, changed), header));
  }
  return points;
}

}  // namespace waymark::importers
