// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <utility>
namespace waymark::importers {

/// Holds the 256 blocks of a grid that were used last. Thread-safe; two threads may compute one block twice.
template <class Block>
class RecentBlocks {
 public:
  /// Returns a block, made by `compute` unless it is held.
  std::shared_ptr<const Block> at(std::int64_t column, std::int64_t row, const auto& compute) {
    const std::int64_t key = row * (1 << 24) + column;
    {
      const std::scoped_lock lock(mutex_);
      for (auto it = blocks_.begin(); it != blocks_.end(); ++it)
        if (it->first == key) {
          blocks_.splice(blocks_.begin(), blocks_, it);
          return it->second;
        }
    }
    auto made = std::make_shared<const Block>(compute());
    const std::scoped_lock lock(mutex_);
    blocks_.emplace_front(key, made);
    if (blocks_.size() > kKept) blocks_.pop_back();
    return made;
  }

 private:
  static constexpr std::size_t kKept = 256;
  std::mutex mutex_;
  std::list<std::pair<std::int64_t, std::shared_ptr<const Block>>> blocks_;  ///< most recently used first
};

}  // namespace waymark::importers
