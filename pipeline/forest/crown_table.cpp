// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/crown_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/bytes.hpp"

namespace waymark::pipeline {
namespace {

// Variable-length code: seven bits a byte, the lowest first; small numbers of either sign are short.
void put(std::string& bytes, std::int64_t value) {
  auto left = (static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63);
  for (; left >= 128; left >>= 7) bytes.push_back(static_cast<char>(left | 128));
  bytes.push_back(static_cast<char>(left));
}

std::int64_t get(const std::string& bytes, std::size_t& at) {
  std::uint64_t value = 0;
  for (int shift = 0; shift < 64; shift += 7) {
    const auto byte = static_cast<unsigned char>(bytes.at(at++));
    value |= static_cast<std::uint64_t>(byte & 127) << shift;
    if (byte < 128) break;
  }
  return static_cast<std::int64_t>(value >> 1) ^ -static_cast<std::int64_t>(value & 1);
}

// First corner relative to the top, then alternating vertical and horizontal steps.
void put_ring(std::string& bytes, const std::vector<CanopyCell>& ring, const CanopyCell& top) {
  if (ring.empty()) return;
  put(bytes, ring[0].column - top.column);
  put(bytes, ring[0].row - top.row);
  for (std::size_t i = 1; i < ring.size(); ++i) {
    const std::int64_t across = ring[i].column - ring[i - 1].column, down = ring[i].row - ring[i - 1].row;
    const bool vertical = i % 2 == 1;
    if ((vertical ? across : down) != 0) throw std::logic_error("an outline leaves the edges of cells");
    put(bytes, vertical ? down : across);
  }
}

}  // namespace

std::uint32_t CrownTable::number_of(const Survey& survey) {
  const auto known = std::ranges::find(surveys_, survey);
  const auto number = static_cast<std::uint32_t>(known - surveys_.begin());
  if (known == surveys_.end()) surveys_.push_back(survey);
  return number;
}

std::uint32_t CrownTable::add_survey(const CanopySource& canopy) {
  const Georeference& where = canopy.geometry().where;
  const double metres = where.crs.metres_per_unit();
  return number_of(
      {canopy.name(), where.x0, where.y0, where.dx, where.dy, where.dx * metres, -where.dy * metres});
}

void CrownTable::add(std::uint32_t survey, const DetectedTree& tree) {
  crowns_.push_back({.column = static_cast<std::int32_t>(tree.top.column),
                     .row = static_cast<std::int32_t>(tree.top.row),
                     .height = static_cast<float>(tree.height),
                     .cells = static_cast<std::uint32_t>(tree.crown.cells),
                     .survey = survey,
                     .corners = static_cast<std::uint32_t>(tree.crown.ring.size()),
                     .begins = bytes_.size()});
  put(bytes_, 0);
  put_ring(bytes_, tree.crown.ring, tree.top);
}

void CrownTable::add(const CrownTable& from, std::size_t row, std::string_view uid) {
  Packed crown = from.crowns_[row];
  std::size_t outline = crown.begins;
  outline += static_cast<std::size_t>(get(from.bytes_, outline));
  const std::size_t end = row + 1 < from.size() ? from.crowns_[row + 1].begins : from.bytes_.size();
  crown.survey = number_of(from.surveys_[crown.survey]);
  crown.begins = bytes_.size();
  put(bytes_, static_cast<std::int64_t>(uid.size()));
  bytes_.append(uid);
  bytes_.append(from.bytes_, outline, end - outline);
  crowns_.push_back(crown);
}

void CrownTable::shrink_to_fit() {
  crowns_.shrink_to_fit();
  bytes_.shrink_to_fit();
}

Eigen::Vector2d CrownTable::top(std::size_t row) const {
  const Packed& crown = crowns_[row];
  const Survey& s = surveys_[crown.survey];
  return {s.x0 + crown.column * s.dx, s.y0 + crown.row * s.dy};
}

std::string_view CrownTable::uid(std::size_t row) const {
  std::size_t at = crowns_[row].begins;
  const auto letters = static_cast<std::size_t>(get(bytes_, at));
  return std::string_view(bytes_).substr(at, letters);
}

CrownShape CrownTable::at(std::size_t row) const {
  const Packed& crown = crowns_.at(row);
  const Survey& survey = surveys_[crown.survey];
  CrownShape shape;
  shape.uid = uid(row);
  std::size_t at = crown.begins;
  get(bytes_, at);
  at += shape.uid.size();
  shape.source = survey.source;
  shape.top = top(row);
  shape.height = static_cast<double>(crown.height);
  shape.area = static_cast<double>(crown.cells) * survey.width * survey.height;
  shape.diameter = 2 * std::sqrt(shape.area / std::numbers::pi);
  CanopyCell corner{crown.column, crown.row};
  for (std::uint32_t i = 0; i < crown.corners; ++i) {
    if (i % 2 == 0) corner.column += get(bytes_, at);
    if (i % 2 == 1 || i == 0) corner.row += get(bytes_, at);
    shape.ring.emplace_back(survey.x0 + (static_cast<double>(corner.column) - 0.5) * survey.dx,
                            survey.y0 + (static_cast<double>(corner.row) - 0.5) * survey.dy);
  }
  return shape;
}

std::string Codec<CrownTable>::encode(const CrownTable& crowns) {
  ByteWriter out;
  out(static_cast<std::uint64_t>(crowns.surveys_.size()));
  for (const auto& s : crowns.surveys_)
    out(s.source), out(s.x0), out(s.y0), out(s.dx), out(s.dy), out(s.width), out(s.height);
  out(crowns.crowns_);
  out(crowns.bytes_);
  return out.take();
}

CrownTable Codec<CrownTable>::decode(std::string_view bytes) {
  ByteReader in(bytes);
  CrownTable crowns;
  crowns.surveys_.resize(in.length(56));
  for (auto& s : crowns.surveys_)
    in(s.source), in(s.x0), in(s.y0), in(s.dx), in(s.dy), in(s.width), in(s.height);
  in(crowns.crowns_);
  in(crowns.bytes_);
  in.expect_end();
  for (const auto& crown : crowns.crowns_)
    if (crown.survey >= crowns.surveys_.size() || crown.begins >= crowns.bytes_.size())
      throw std::runtime_error("artifact of crowns is inconsistent");
  return crowns;
}

}  // namespace waymark::pipeline
