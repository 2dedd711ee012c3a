// SPDX-License-Identifier: Apache-2.0
#include "geodb/row_order.hpp"

#include <algorithm>
#include <vector>

#include "geodb/hilbert.hpp"

namespace waymark {
namespace {

std::uint16_t scaled(double value, double lowest, double highest) {
  if (!(highest > lowest)) return 0;
  return static_cast<std::uint16_t>((value - lowest) / (highest - lowest) * 65535);
}

struct Place {
  std::uint32_t along, index;
};

}  // namespace

Envelope extent_of(std::span<const Landmark> landmarks, std::span<const std::uint32_t> indices) {
  Envelope box;
  for (const std::uint32_t i : indices) box.add(landmarks[i].position.xyz.x(), landmarks[i].position.xyz.y());
  return box;
}

void sort_along_hilbert_curve(std::span<std::uint32_t> indices, std::span<const Landmark> landmarks,
                              const Envelope& extent) {
  std::vector<Place> places;
  places.reserve(indices.size());
  for (const std::uint32_t i : indices) {
    const auto& at = landmarks[i].position.xyz;
    places.push_back({hilbert_index(scaled(at.x(), extent.min_x, extent.max_x),
                                    scaled(at.y(), extent.min_y, extent.max_y)),
                      i});
  }
  std::ranges::sort(places, [&](const Place& a, const Place& b) {
    return a.along != b.along ? a.along < b.along : landmarks[a.index].uid < landmarks[b.index].uid;
  });
  std::ranges::transform(places, indices.begin(), &Place::index);
}

void fetch_ahead(std::span<const Landmark> landmarks, std::span<const std::uint32_t> indices,
                 std::size_t at) {
  constexpr std::size_t kFar = 16, kNear = 8, kLine = 64;  // steps, steps, bytes
  const auto fetch = [](const void* begin, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; i += kLine)
      __builtin_prefetch(static_cast<const std::byte*>(begin) + i);
  };
  if (at + kFar < indices.size()) fetch(&landmarks[indices[at + kFar]], sizeof(Landmark));
  if (at + kNear >= indices.size()) return;
  const Landmark& near = landmarks[indices[at + kNear]];
  fetch(near.features.data(), near.features.size() * sizeof(FeatureValue));
  fetch(near.quality.of_feature.data(), near.quality.of_feature.size() * sizeof(std::optional<double>));
  fetch(near.uid.data(), near.uid.size());
}

}  // namespace waymark
