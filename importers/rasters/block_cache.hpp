// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>
#include "importers/rasters/block.hpp"
namespace waymark::importers {

/// Cache of decoded blocks of all files of a DEM, shared by all threads: neighbouring windows share blocks,
/// and decompression costs ten times the copying. Evicts the least recently used block.
class BlockCache {
 public:
  explicit BlockCache(std::size_t bytes) : limit_(bytes) {}

  struct Key {
    std::uint32_t file = 0;
    std::uint64_t block = 0;
    friend bool operator==(const Key&, const Key&) = default;
  };

  /// Returns the block, decoded by `read` if it is not cached. Two threads may decode the same block at once;
  /// both get the same cells.
  std::shared_ptr<const Block> get(const Key& key, const std::function<Block()>& read);

 private:
  struct Hash {
    std::size_t operator()(const Key& key) const { return key.block * 0x9E3779B97F4A7C15u + key.file; }
  };
  struct Entry {
    Key key;
    std::shared_ptr<const Block> block;
  };

  std::shared_ptr<const Block> find(const Key& key);
  void keep(const Key& key, std::shared_ptr<const Block> block);

  std::size_t limit_, used_ = 0;
  std::mutex mutex_;
  std::list<Entry> entries_;  // most recently used first
  std::unordered_map<Key, std::list<Entry>::iterator, Hash> places_;
};

}  // namespace waymark::importers
