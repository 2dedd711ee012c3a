// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string_view>
#include <vector>
#include "core/landmark.hpp"
namespace waymark::inline landmarks {

/// Hash index of landmarks by uid, about ten bytes per landmark. The landmarks must outlive it with unchanged
/// uids.
class UidIndex {
 public:
  explicit UidIndex(std::span<const Landmark> landmarks);
  /// Indexes a subset, given by positions in `landmarks`; both spans must outlive the index.
  UidIndex(std::span<const Landmark> landmarks, std::span<const std::uint32_t> subset);

  /// Returns the position of the first landmark of that uid in `landmarks`, or in the subset.
  std::optional<std::uint32_t> find(std::string_view uid) const;

 private:
  static constexpr std::uint32_t kFree = 0xffffffff;
  void fill(std::size_t count);
  std::string_view uid(std::uint32_t i) const { return landmarks_[subset_.empty() ? i : subset_[i]].uid; }
  std::size_t slot(std::string_view uid) const;  ///< slot of the uid, or the free slot for it

  std::span<const Landmark> landmarks_;
  std::span<const std::uint32_t> subset_;  ///< empty: all
  std::vector<std::uint32_t> slots_;       ///< their number is a power of two
};

}  // namespace waymark::inline landmarks
