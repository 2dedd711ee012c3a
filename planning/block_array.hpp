// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/mman.h>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>
#include <vector>
namespace waymark::planning {

/// Array that grows to millions of plain values, in blocks that never move. Each is one huge page where the
/// system has them: random reads of small pages wait for their addresses.
template <class T>
class BlockArray {
 public:
  std::size_t size() const { return size_; }
  const T& operator[](std::size_t i) const { return blocks_[i / kPerBlock].get()[i % kPerBlock]; }

  void push_back(const T& value) {
    if (size_ % kPerBlock == 0) blocks_.push_back(allocate());
    new (blocks_.back().get() + size_ % kPerBlock) T(value);
    ++size_;
  }

 private:
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
  static_assert((sizeof(T) & (sizeof(T) - 1)) == 0, "a block holds a power of two");
  static constexpr std::size_t kBlock = 2 << 20;  // bytes
  static constexpr std::size_t kPerBlock = kBlock / sizeof(T);

  struct Free {
    void operator()(T* data) const { std::free(data); }
  };
  using Block = std::unique_ptr<T, Free>;

  static Block allocate() {
    void* const data = std::aligned_alloc(kBlock, kBlock);
    if (!data) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
    madvise(data, kBlock, MADV_HUGEPAGE);  // refused: small pages
#endif
    return Block(static_cast<T*>(data));
  }

  std::vector<Block> blocks_;
  std::size_t size_ = 0;
};

}  // namespace waymark::planning
