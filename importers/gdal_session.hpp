// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
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

 private:
  std::string first_error_;
};

/// Opens a raster for reading; /vsistdin/ any number of times. Throws Error{input} if the file is missing,
/// empty or of no format that GDAL knows, with GDAL's message.
GdalDataset open_raster(const std::string& path);

}  // namespace waymark::importers
