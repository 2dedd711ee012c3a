// SPDX-License-Identifier: Apache-2.0
#include "importers/points/laz/pointwise_points.hpp"

#include <array>
#include <cstring>
#include <optional>

#include "importers/points/laz/gps_time_decoder.hpp"
#include "importers/points/laz/integer_decoder.hpp"
#include "importers/points/laz/return_context.hpp"
#include "importers/points/laz/running_median.hpp"

namespace waymark::importers {
namespace {

// Models of a byte, one for each value of the byte before; made when they are first needed.
class ByteAfterByte {
 public:
  unsigned char next(ArithmeticDecoder& from, unsigned char last) {
    SymbolModel& model = models_[last];
    if (!model.ready()) model.reset(256);
    return static_cast<unsigned char>(from.symbol(model));
  }

 private:
  std::array<SymbolModel, 256> models_;
};

// The first 20 bytes of a point. Which fields changed comes first, then the fields, then x, y and z.
class Point10 {
 public:
  explicit Point10(const unsigned char* record) {
    std::memcpy(record_.data(), record, record_.size());
    std::memcpy(at_.data(), record, sizeof at_);
  }

  const unsigned char* next(ArithmeticDecoder& from) {
    const unsigned changed = from.symbol(changes_);
    if (changed & 32) record_[14] = flags_.next(from, record_[14]);
    const unsigned number = record_[14] & 7U, returns = (record_[14] >> 3) & 7U;
    const unsigned context = return_context8(returns, number), level = return_level(returns, number);
    if (changed & 16) intensity_.correction(from, std::min(context, 3U));
    if (changed & 8) record_[15] = class_.next(from, record_[15]);
    if (changed & 4) from.symbol(scan_angle_[(record_[14] >> 6) & 1U]);
    if (changed & 2) record_[17] = user_data_.next(from, record_[17]);
    if (changed & 1) source_.correction(from);

    const unsigned single = returns == 1 ? 1 : 0;
    move(0, x_.next(from, medians_[0][context].get(), single), context);
    move(1, y_.next(from, medians_[1][context].get(), single + even_context(x_.magnitude(), 20)), context);
    const unsigned bits = (x_.magnitude() + y_.magnitude()) / 2;
    heights_[level] = at_[2] = z_.next(from, heights_[level], single + even_context(bits, 18));
    std::memcpy(record_.data(), at_.data(), sizeof at_);
    return record_.data();
  }

 private:
  void move(std::size_t axis, std::int32_t step, unsigned context) {
    at_[axis] =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(at_[axis]) + static_cast<std::uint32_t>(step));
    medians_[axis][context].add(step);
  }

  std::array<unsigned char, 20> record_;
  std::array<std::int32_t, 3> at_;
  SymbolModel changes_{64};
  ByteAfterByte flags_, class_, user_data_;
  std::array<SymbolModel, 2> scan_angle_{SymbolModel(256), SymbolModel(256)};
  IntegerDecoder intensity_{16, 4}, source_{16}, x_{32, 2}, y_{32, 22}, z_{32, 20};
  std::array<std::array<RunningMedian, 16>, 2> medians_;
  std::array<std::int32_t, 8> heights_{};
};

// Colours: which of six bytes changed, and whether it is a colour at all (64), then the bytes.
class Rgb12 {
 public:
  void skip(ArithmeticDecoder& from) {
    const unsigned changed = from.symbol(changes_);
    for (const unsigned byte : {0U, 1U, 2U, 4U, 3U, 5U})
      if ((changed >> byte & 1U) != 0 && (byte < 2 || (changed & 64) != 0)) from.symbol(bytes_[byte]);
  }

 private:
  SymbolModel changes_{128};
  std::array<SymbolModel, 6> bytes_{SymbolModel(256), SymbolModel(256), SymbolModel(256),
                                    SymbolModel(256), SymbolModel(256), SymbolModel(256)};
};

class Wave13 {
 public:
  void skip(ArithmeticDecoder& from) {
    from.symbol(index_);
    last_ = from.symbol(offset_kinds_[last_]);
    if (last_ == 2) offset_.correction(from);
    if (last_ == 3) from.bits(32), from.bits(32);
    size_.correction(from);
    return_point_.correction(from);
    for (const unsigned axis : {0U, 1U, 2U}) direction_.correction(from, axis);
  }

 private:
  SymbolModel index_{256};
  std::array<SymbolModel, 4> offset_kinds_{SymbolModel(4), SymbolModel(4), SymbolModel(4), SymbolModel(4)};
  unsigned last_ = 0;
  IntegerDecoder offset_{32}, size_{32}, return_point_{32}, direction_{32, 3};
};

}  // namespace

std::vector<LasPoint> pointwise_points(std::span<const unsigned char> chunk, const LasHeader& header,
                                       std::uint64_t count) {
  const auto length = static_cast<std::size_t>(header.point_length);
  std::vector<LasPoint> points;
  if (count == 0) return points;
  if (chunk.size() < length) throw DamagedChunk{};
  // No file has more than some hundred points per byte; a false count must not reserve memory.
  points.reserve(static_cast<std::size_t>(std::min<std::uint64_t>(count, 16 * chunk.size())));
  points.push_back(las_point(chunk.data(), header));  // the first point is not compressed
  if (count == 1) return points;

  ArithmeticDecoder from(chunk.subspan(length));
  Point10 point(chunk.data());
  std::optional<GpsTimeDecoder> time;
  std::optional<Rgb12> colours;
  std::optional<Wave13> wave;
  std::vector<SymbolModel> extra;
  std::size_t offset = 0;
  for (const LazItem& item : header.laz->items) {
    if (item.type == LazType::gps_time) time.emplace(chunk.data() + offset);
    if (item.type == LazType::rgb12) colours.emplace();
    if (item.type == LazType::wave13) wave.emplace();
    if (item.type == LazType::bytes) extra.assign(item.size, SymbolModel(256));
    offset += item.size;
  }
  while (points.size() < count) {
    points.push_back(las_point(point.next(from), header));
    if (time) time->next(from);
    if (colours) colours->skip(from);
    if (wave) wave->skip(from);
    for (SymbolModel& byte : extra) from.symbol(byte);
  }
  return points;
}

}  // namespace waymark::importers
