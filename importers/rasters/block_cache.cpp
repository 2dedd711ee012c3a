// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/block_cache.hpp"

namespace waymark::importers {

std::shared_ptr<const Block> BlockCache::get(const Key& key, const std::function<Block()>& read) {
  if (auto block = find(key)) return block;
  auto block = std::make_shared<const Block>(read());
  keep(key, block);
  return block;
}

std::shared_ptr<const Block> BlockCache::find(const Key& key) {
  const std::scoped_lock lock(mutex_);
  const auto found = places_.find(key);
  if (found == places_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found->second);
  return found->second->block;
}

void BlockCache::keep(const Key& key, std::shared_ptr<const Block> block) {
  const std::scoped_lock lock(mutex_);
  if (places_.contains(key)) return;  // another thread has added it
  used_ += block->bytes();
  entries_.push_front({key, std::move(block)});
  places_.emplace(key, entries_.begin());
  while (used_ > limit_ && entries_.size() > 1) {
    used_ -= entries_.back().block->bytes();
    places_.erase(entries_.back().key);
    entries_.pop_back();
  }
}

}  // namespace waymark::importers
