// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>
#include "geo/dem_source.hpp"
#include "importers/rasters/block_cache.hpp"
#include "importers/rasters/mosaic_layout.hpp"
#include "importers/rasters/raster_handles.hpp"
namespace waymark {

/// Heights of several files on one grid, as they are in the files. Safe to read from many threads.
class Mosaic {
 public:
  /// `cache_bytes`: decoded blocks kept for later windows.
  Mosaic(std::vector<RasterHeader> headers, std::size_t cache_bytes);

  const GridGeometry& grid() const { return layout_.grid; }
  const std::vector<RasterHeader>& headers() const { return headers_; }
  /// Where a file lies in the grid.
  const Window& window_of(std::size_t file) const { return layout_.files[file]; }

  /// The contract of DemSource::read; of overlapping files the first one that has a height wins.
  HeightWindow read(const Window& window) const;
  /// Heights of one file alone; the window is of the grid and inside the file.
  HeightWindow read_file(std::size_t file, const Window& window) const;

 private:
  void add_heights(const Window& inside, const Window& window, HeightWindow& heights) const;
  void add_file(std::size_t file, const Window& part, const Window& window, HeightWindow& heights) const;

  std::vector<RasterHeader> headers_;
  MosaicLayout layout_;
  mutable BlockCache cache_;
  mutable RasterHandles handles_;
};

/// The common part; without cells where there is none.
Window common(const Window& a, const Window& b);

}  // namespace waymark
