// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>
namespace waymark::planning {

/// Entry of a BucketQueue.
struct QueueEntry {
  double key;                 ///< >= 0
  std::uint32_t number;       ///< the smaller one is first among equal keys
  std::uint32_t value, more;  ///< of the caller
};

/// Takes the smallest entry first, as std::priority_queue with std::greater does. Meant for searches, whose
/// keys hardly fall below the last one taken: entries lie in buckets of equal width, and only the bucket in
/// use is a heap, small enough for the cache.
class BucketQueue {
 public:
  /// `width` > 0 is that of a bucket; the first bucket begins at `first_key`. Any width and first key give
  /// the same order.
  BucketQueue(double first_key, double width) : first_key_(first_key), per_width_(1 / width), buckets_(1) {}

  bool empty() const { return count_ == 0; }

  void push(const QueueEntry& entry) {
    ++count_;
    const std::size_t to = std::max(bucket(entry.key), current_);
    if (to >= buckets_.size()) buckets_.resize(to + 1);
    buckets_[to].push_back(entry);
    if (to == current_) std::ranges::push_heap(buckets_[to], IsLater());
  }

  QueueEntry pop() {
    while (buckets_[current_].empty()) advance();
    std::vector<QueueEntry>& heap = buckets_[current_];
    std::ranges::pop_heap(heap, IsLater());
    const QueueEntry first = heap.back();
    heap.pop_back();
    --count_;
    return first;
  }

 private:
  // Whole numbers of 128 bits, for a heap without branches: doubles >= 0 are ordered as their bits are.
  struct IsLater {
    bool operator()(const QueueEntry& a, const QueueEntry& b) const { return order(a) > order(b); }

    __extension__ using Order = unsigned __int128;
    static Order order(const QueueEntry& e) {
      return Order{std::bit_cast<std::uint64_t>(e.key)} << 64 | Order{e.number};
    }
  };

  static constexpr double kMaxBuckets = 1 << 16;  // the last one takes all larger keys

  std::size_t bucket(double key) const {
    const double at = (key - first_key_) * per_width_;
    return at > 0 ? static_cast<std::size_t>(std::min(at, kMaxBuckets)) : 0;
  }

  void advance() {
    std::vector<QueueEntry>().swap(buckets_[current_]);
    ++current_;
    std::ranges::make_heap(buckets_[current_], IsLater());
  }

  double first_key_, per_width_;
  std::size_t count_ = 0, current_ = 0;
  std::vector<std::vector<QueueEntry>> buckets_;
};

}  // namespace waymark::planning
