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

  /// Returns true if GDAL goes on without a part of the file, and only warns. It makes up the pixels of a
  /// JPEG that ends early. It leaves out tags of a TIFF that cannot be read, such as the CRS.
  bool content_is_missing() const { return content_is_missing_; }

 private:
  void hear(int level, std::string_view text);

  std::string first_error_;
  bool content_is_missing_ = false;
};

/// Opens a raster for reading; /vsistdin/ any number of times. Throws Error{input} if the file is missing,
/// empty, without a part of its header, or of no format that GDAL knows, with GDAL's message.
GdalDataset open_raster(const std::string& path);

}  // namespace waymark::importers
