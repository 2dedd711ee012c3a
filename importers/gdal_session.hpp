// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
class GDALDataset;
namespace waymark {

struct GdalClose {
  void operator()(GDALDataset* dataset) const;
};

/// An open file of GDAL. To be used by one thread at a time.
using GdalDataset = std::unique_ptr<GDALDataset, GdalClose>;

/// Keeps what GDAL says in this thread while it lives, so that nothing leaks to the terminal. Registers the
/// drivers when first used.
class GdalListener {
 public:
  GdalListener();
  ~GdalListener();
  GdalListener(GdalListener&&) = delete;

  /// The first error, which names the cause; empty if there was none. A leading `path` is left out.
  std::string error_about(const std::string& path) const;

 private:
  std::string first_error_;
};

/// Opens a raster for reading. Throws Error{input} that says whether the file is missing, empty or of no kind
/// that GDAL knows, and what GDAL said.
GdalDataset open_raster(const std::string& path);

}  // namespace waymark
