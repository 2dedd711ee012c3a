// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>
#include "geo/dem_source.hpp"
#include "importers/rasters/block.hpp"
#include "importers/rasters/mosaic_layout.hpp"
#include "importers/rasters/raster_handles.hpp"
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

/// Heights of several files on one grid, without interpolation. Safe to read from many threads.
class Mosaic {
 public:
  /// `cache_bytes` limits the decoded blocks kept for later windows.
  Mosaic(std::vector<RasterHeader> headers, std::size_t cache_bytes);

  const GridGeometry& grid() const { return layout_.grid; }
  const std::vector<RasterHeader>& headers() const { return headers_; }
  /// Returns the window of a file in the grid.
  const Window& window_of(std::size_t file) const { return layout_.files[file]; }

  /// Implements DemSource::read; of overlapping files the first one with a height has priority.
  HeightWindow read(const Window& window) const;
  /// Reads heights of one file alone; the window is in grid coordinates and inside the file.
  HeightWindow read_file(std::size_t file, const Window& window) const;
  /// Counts the cells of all files in a window inside the grid whose numbers are no heights.
  CellFaults implausible(const Window& window) const;

 private:
  void for_each_row(std::size_t file, const Window& part, auto&& visit) const;
  void add_heights(const Window& inside, const Window& window, HeightWindow& heights) const;
  void add_file(std::size_t file, const Window& part, const Window& window, HeightWindow& heights) const;

  std::vector<RasterHeader> headers_;
  MosaicLayout layout_;
  mutable BlockCache cache_;
  mutable RasterHandles handles_;
};

/// Returns the intersection of two windows; it has no cells if they are disjoint.
Window intersection(const Window& a, const Window& b);

}  // namespace waymark::importers
