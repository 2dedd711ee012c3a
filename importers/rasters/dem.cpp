// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/dem.hpp"

#include <gdal.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/error.hpp"
#include "importers/rasters/dem_memory.hpp"
#include "importers/rasters/fill_voids.hpp"
#include "importers/rasters/inspect.hpp"
#include "importers/rasters/metric_dem.hpp"
#include "importers/rasters/mosaic.hpp"
#include "importers/tables/area_of_interest.hpp"

namespace waymark::importers {
namespace {

std::vector<RasterHeader> read_headers(const DemImport& import) {
  if (import.files.empty())
    throw Error(ErrorCode::usage, "no DEM is given", "", "name one or more raster files");
  std::vector<RasterHeader> headers;
  for (const std::string& path : import.files)
    headers.push_back(
        read_header(*open_raster(path), path,
                    {import.crs, static_cast<int>(import.band), import.height_unit, import.height_scale}));
  return headers;
}

class MosaicDem : public ImportedDem {
 public:
  explicit MosaicDem(const DemImport& import) : MosaicDem(import, read_headers(import)) {}
  MosaicDem(const DemImport& import, std::vector<RasterHeader> headers)
      : import_(import),
        memory_(dem_memory(import.memory_bytes, headers)),
        mosaic_(std::move(headers), cache_bytes()) {
    GDALSetCacheMax64(memory_ / 8);  // GDAL's cache, used for VRTs and masks
    for (const RasterHeader& header : mosaic_.headers())
      warnings_.insert(warnings_.end(), header.warnings.begin(), header.warnings.end());
    if (!import.area.empty()) {
      area_ = read_area_of_interest(import.area, geometry().where.crs);
      check_area_meets(*area_, geometry(), "the DEM", import.area);
    }
    if (!import.inspect) return;
    for (std::string& warning : inspect(mosaic_, cache_bytes())) warnings_.push_back(std::move(warning));
  }

  const GridGeometry& geometry() const override { return mosaic_.grid(); }
  NodataPolicy nodata_policy() const override { return import_.nodata; }
  HeightWindow read(const Window& window) const override {
    return import_.nodata == NodataPolicy::fill
               ? read_filled(mosaic_, window, static_cast<int>(import_.fill_distance))
               : mosaic_.read(window);
  }
  bool in_area(double x, double y) const override { return !area_ || area_->contains(x, y); }
  CellFaults faults(const Window& window) const override {
    CellFaults found = mosaic_.implausible(window);
    if (import_.nodata != NodataPolicy::fill) return found;
    const HeightWindow raw = mosaic_.read(window);
    const std::int64_t voids = std::ranges::count(raw.cells(), kNoHeight);
    if (voids > 0) found.filled = voids - std::ranges::count(read(window).cells(), kNoHeight);
    return found;
  }
  double height_sd() const override { return import_.height_sd.value; }
  std::vector<std::string> files() const override { return import_.files; }
  const std::vector<std::string>& warnings() const override { return warnings_; }
  bool has_square_blocks() const override {
    return std::ranges::all_of(mosaic_.headers(), &RasterHeader::square_blocks);
  }
  const DemImport& import() const override { return import_; }

 private:
  std::size_t cache_bytes() const { return static_cast<std::size_t>(memory_ / 8 * 7); }

  DemImport import_;
  std::int64_t memory_;  ///< bytes
  Mosaic mosaic_;
  std::optional<Area> area_;
  std::vector<std::string> warnings_;
};

}  // namespace

std::shared_ptr<const ImportedDem> import_dem(const DemImport& import) {
  std::shared_ptr<const ImportedDem> dem = std::make_shared<const MosaicDem>(import);
  return import.metric ? project_to_metres(std::move(dem)) : dem;
}

int band_count(const std::string& path) {
  return open_raster(path)->GetRasterCount();
}

}  // namespace waymark::importers
