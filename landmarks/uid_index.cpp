// SPDX-License-Identifier: Apache-2.0
#include "landmarks/uid_index.hpp"

#include <bit>
#include <functional>

namespace waymark::inline landmarks {

UidIndex::UidIndex(std::span<const Landmark> landmarks) : landmarks_(landmarks) {
  fill(landmarks.size());
}

UidIndex::UidIndex(std::span<const Landmark> landmarks, std::span<const std::uint32_t> subset)
    : landmarks_(landmarks), subset_(subset) {
  fill(subset.size());
}

void UidIndex::fill(std::size_t count) {
  slots_.assign(std::bit_ceil(3 * count / 2 + 1), kFree);
  for (std::uint32_t i = 0; i < count; ++i)
    if (std::uint32_t& entry = slots_[slot(uid(i))]; entry == kFree) entry = i;
}

std::size_t UidIndex::slot(std::string_view uid) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t at = std::hash<std::string_view>{}(uid)&mask;
  while (slots_[at] != kFree && this->uid(slots_[at]) != uid) at = (at + 1) & mask;
  return at;
}

std::optional<std::uint32_t> UidIndex::find(std::string_view uid) const {
  const std::uint32_t entry = slots_[slot(uid)];
  return entry == kFree ? std::nullopt : std::optional(entry);
}

}  // namespace waymark::inline landmarks
