// SPDX-License-Identifier: Apache-2.0
#include "geodb/rtree/landmark_order.hpp"

#include <algorithm>
#include <deque>
#include <stdexcept>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace waymark::geodb {
namespace {

/// Prefetches the landmarks soon after `at`, since landmarks in curve order are scattered in memory.
void fetch_ahead(const auto& rows, std::size_t at) {
  constexpr std::size_t kFar = 16, kNear = 8, kLine = 64;  // steps, steps, bytes
  const auto fetch = [](const void* begin, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; i += kLine)
      __builtin_prefetch(static_cast<const std::byte*>(begin) + i);
  };
  if (at + kFar < rows.size()) fetch(rows[at + kFar].landmark, sizeof(Landmark));
  if (at + kNear >= rows.size()) return;
  const Landmark& near = *rows[at + kNear].landmark;
  fetch(near.features.data(), near.features.size() * sizeof(FeatureValue));
  fetch(near.quality.feature_confidences.data(),
        near.quality.feature_confidences.size() * sizeof(std::optional<double>));
  fetch(near.uid.data(), near.uid.size());
}

}  // namespace

struct LandmarkOrder::Rows {
  std::deque<Landmark> copies;  ///< of parts
  std::vector<Row> all;         ///< in order
};

LandmarkOrder::LandmarkOrder(const MapContents& contents, TypeId type, const Envelope& extent,
                             std::size_t max_in_memory)
    : contents_(&contents), type_(type), extent_(extent) {
  const auto positions = [&](std::size_t number, const auto& take) {
    const auto landmarks = part(number);
    for (const Landmark& landmark : *landmarks)
      if (landmark.type == type_) take(landmark.position.xyz.head<2>());
  };
  ranges_ = divide_hilbert_curve(contents.parts.count + 1, positions, extent, max_in_memory);
}

/// The last part is the landmarks of the contents themselves.
std::shared_ptr<const std::vector<Landmark>> LandmarkOrder::part(std::size_t number) const {
  if (number < contents_->parts.count) return contents_->parts.landmarks(number);
  return {std::shared_ptr<void>(), &contents_->landmarks};
}

LandmarkOrder::Rows LandmarkOrder::read_rows(const HilbertRange& range) const {
  Rows rows;
  for (const std::uint32_t number : range.parts) {
    const auto landmarks = part(number);
    for (const Landmark& landmark : *landmarks) {
      if (landmark.type != type_) continue;
      const std::uint32_t curve_position = hilbert_position(landmark.position.xyz.head<2>(), extent_);
      if (!range.contains(curve_position)) continue;
      const bool resident = number == contents_->parts.count;
      rows.all.push_back(
          {curve_position, number, resident ? &landmark : &rows.copies.emplace_back(landmark)});
    }
  }
  std::ranges::sort(rows.all, [](const Row& a, const Row& b) {
    return a.curve_position != b.curve_position ? a.curve_position < b.curve_position
                                                : a.landmark->uid < b.landmark->uid;
  });
  return rows;
}

void LandmarkOrder::visit(const std::function<void(const Landmark&, std::int64_t)>& take,
                          const std::function<void()>& before_release) const {
  std::int64_t row_index = 0;
  for (const HilbertRange& range : ranges_) {
    const Rows rows = read_rows(range);
    for (std::size_t i = 0; i < rows.all.size(); ++i) {
      fetch_ahead(rows.all, i);
      take(*rows.all[i].landmark, row_index++);
    }
    if (before_release) before_release();
  }
}

void LandmarkOrder::visit_evidence(const std::function<void(const Observation&, std::int64_t)>& take) const {
  if (contents_->parts.count == 0 || !contents_->parts.evidence) return;
  struct Piece {
    std::int64_t row_index;
    std::uint32_t index;  // in its part
    const Observation* observation;
  };
  std::int64_t begin = 0;
  std::vector<std::size_t> missing(contents_->parts.count);  // observations of unread landmarks, by part
  std::vector<bool> visited(contents_->parts.count);
  for (const HilbertRange& range : ranges_) {
    const Rows rows = read_rows(range);
    std::unordered_map<std::uint32_t, std::unordered_map<std::string_view, std::int64_t>> positions;
    for (std::size_t i = 0; i < rows.all.size(); ++i)
      positions[rows.all[i].part].emplace(rows.all[i].landmark->uid, begin + static_cast<std::int64_t>(i));
    begin += static_cast<std::int64_t>(rows.all.size());
    std::deque<Observation> copies;
    std::vector<Piece> pieces;
    for (const std::uint32_t number : range.parts) {
      if (number == contents_->parts.count) continue;
      const auto evidence = contents_->parts.evidence(number);
      const auto& known = positions[number];
      for (std::uint32_t i = 0; i < evidence->size(); ++i) {
        const Observation& o = (*evidence)[i];
        if (!o.rejected.empty())
          throw std::logic_error("the evidence of a part contains a rejected observation");
        if (o.type != type_) continue;
        missing[number] += visited[number] ? 0 : 1;
        const auto found = known.find(o.landmark_uid);
        if (found == known.end()) continue;
        pieces.push_back({found->second, i, &copies.emplace_back(o)});
        --missing[number];
      }
      visited[number] = true;
    }
    std::ranges::sort(pieces, {}, [](const Piece& p) { return std::pair(p.row_index, p.index); });
    for (const Piece& piece : pieces) take(*piece.observation, piece.row_index);
  }
  if (std::ranges::any_of(missing, [](std::size_t n) { return n > 0; }))
    throw std::logic_error("the evidence of a part refers to a landmark outside the part");
}

}  // namespace waymark::geodb
