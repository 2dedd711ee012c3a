// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <string_view>
class GDALDataset;
namespace waymark::importers {

struct GdalClose {
  void operator()(GDALDataset* dataset) const;
};

/// A file opened by GDAL. One thread at a time may use it.
using GdalDataset = std::unique_ptr<GDALDataset, GdalClose>;

/// Collects GDAL's messages of this thread while it lives and keeps them off the terminal. Registers the
/// drivers at first use.
class GdalListener {
 public:
  GdalListener();
  ~GdalListener();
  GdalListener(GdalListener&&) = delete;

  /// Returns the first error, which names the cause; empty if there was none. Removes a leading `path`.
  std::string error_about(const std::string& path) const;

  /// Returns true if a decoder made up pixels that the file lacks: GDAL only warns of a JPEG that ends early.
  bool pixels_are_missing() const { return pixels_are_missing_; }

 private:
  void hear(int level, std::string_view text);

  std::string first_error_;
  bool pixels_are_missing_ = false;
};

/// Opens a raster for reading; /vsistdin/ any number of times. Throws Error{input} if the file is missing,
/// empty or of no format that GDAL knows, with GDAL's message.
GdalDataset open_raster(const std::string& path);

}  // namespace waymark::importers
