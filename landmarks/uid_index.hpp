// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string_view>
#include <vector>
#include "core/landmark.hpp"
namespace waymark {

/// Finds landmarks by uid. Holds numbers alone, about ten bytes a landmark: the landmarks must outlive it and
/// keep their uids.
class UidIndex {
 public:
  explicit UidIndex(std::span<const Landmark> landmarks);
  /// Of some of them, by their places in `landmarks`, which must outlive the index, too.
  UidIndex(std::span<const Landmark> landmarks, std::span<const std::uint32_t> some);

  /// Place among the landmarks, or among `some`; of several that share the uid the first.
  std::optional<std::uint32_t> find(std::string_view uid) const;

 private:
  static constexpr std::uint32_t kFree = 0xffffffff;
  void fill(std::size_t count);
  std::string_view uid(std::uint32_t i) const { return landmarks_[some_.empty() ? i : some_[i]].uid; }
  std::size_t slot(std::string_view uid) const;  ///< that holds the uid, or the free one where it belongs

  std::span<const Landmark> landmarks_;
  std::span<const std::uint32_t> some_;  ///< empty: all
  std::vector<std::uint32_t> slots_;     ///< a power of two of them
};

}  // namespace waymark
