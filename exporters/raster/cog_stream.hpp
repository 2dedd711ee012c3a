// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>
#include "core/grid.hpp"
#include "geo/georeference.hpp"
namespace waymark::exporters {

/// Cloud-optimized GeoTIFF of 32-bit floats that is written by windows and may exceed the memory.
/// - Windows are collected in a hidden file beside the output, as large as the raster without compression.
/// - NaN is no data. Equal cells give equal bytes, whatever the windows and their order.
class CogStream {
 public:
  struct Band {
    std::string name, unit;
  };
  /// Throws Error{output}.
  CogStream(const std::filesystem::path& path, const std::vector<Band>& bands, const GridGeometry& grid);
  ~CogStream();

  /// Writes all bands of a window inside the grid. Throws Error{output}.
  void write(const Window& window, std::span<const Grid<float>> bands);
  /// Writes the file with overviews and replaces an older one. `metadata` becomes items of the file. Throws
  /// Error{output}.
  void commit(const std::map<std::string, std::string>& metadata);

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace waymark::exporters
