// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/is_raster.hpp"

#include <gdal_priv.h>

#include "importers/gdal_session.hpp"

namespace waymark::importers {

bool is_raster(const std::string& path) {
  const GdalListener quiet;
  if (GdalDataset(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY))) return false;
  return bool(GdalDataset(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY)));
}

}  // namespace waymark::importers
