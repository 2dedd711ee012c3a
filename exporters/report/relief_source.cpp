// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/relief_source.hpp"

#include <gdal_priv.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "exporters/gdal_messages.hpp"

namespace waymark::exporters {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr double kLargeFile = 1e8;  // cells; beyond, averaging every cell costs seconds

struct Raster {
  std::unique_ptr<GDALDataset> file;
  Extent extent;
};

bool is_same_body(const OGRSpatialReference* found, const Crs& crs) {
  if (found == nullptr || crs.kind() == CrsKind::local) return true;  // the run got the CRS from an option
  return std::abs(found->GetSemiMajor() / crs.body().equatorial_radius - 1) < 0.01 &&
         (found->IsGeographic() != 0) == (crs.kind() == CrsKind::geographic);
}

std::optional<Raster> open_raster(const std::string& name, const Crs& crs, double near_x) {
  Raster raster;
  raster.file.reset(
      GDALDataset::Open(name.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, nullptr, nullptr, nullptr));
  double t[6];
  if (!raster.file || raster.file->GetRasterCount() != 1 || raster.file->GetGeoTransform(t) != CE_None)
    return {};
  if (t[2] != 0 || t[4] != 0 || !(t[5] < 0) || !is_same_body(raster.file->GetSpatialRef(), crs)) return {};
  const double turn =
      crs.kind() != CrsKind::geographic
          ? 0
          : 360 * std::round((near_x - t[0] - raster.file->GetRasterXSize() * t[1] / 2) / 360);
  raster.extent = {t[0] + turn, t[3] + raster.file->GetRasterYSize() * t[5],
                   t[0] + turn + raster.file->GetRasterXSize() * t[1], t[3]};
  return raster;
}

std::vector<Raster> open_rasters(const std::vector<std::string>& names, const Crs& crs, double near_x) {
  std::vector<Raster> rasters;
  for (const std::string& name : names)
    if (auto raster = open_raster(name, crs, near_x)) rasters.push_back(std::move(*raster));
  return rasters;
}

/// Pixels of a picture that lie wholly inside a raster, and the part of the raster they show.
struct Part {
  Window pixels;
  double x = 0, y = 0, width = 0, height = 0;  ///< raster cells
};

Part part_of(const Relief& relief, const Raster& raster) {
  const double px = relief.extent.width() / static_cast<double>(relief.heights.columns());
  const double py = relief.extent.height() / static_cast<double>(relief.heights.rows());
  const auto clamp = [](double at, std::int64_t limit) {
    return std::clamp<std::int64_t>(std::llround(at), 0, limit);
  };
  Part part;
  part.pixels.column = clamp((raster.extent.west - relief.extent.west) / px, relief.heights.columns());
  part.pixels.row = clamp((relief.extent.north - raster.extent.north) / py, relief.heights.rows());
  part.pixels.columns =
      clamp((raster.extent.east - relief.extent.west) / px, relief.heights.columns()) - part.pixels.column;
  part.pixels.rows =
      clamp((relief.extent.north - raster.extent.south) / py, relief.heights.rows()) - part.pixels.row;
  const double cell_x = raster.extent.width() / raster.file->GetRasterXSize();
  const double cell_y = raster.extent.height() / raster.file->GetRasterYSize();
  const double west = relief.extent.west + px * static_cast<double>(part.pixels.column);
  const double north = relief.extent.north - py * static_cast<double>(part.pixels.row);
  part.x = std::max(0.0, (west - raster.extent.west) / cell_x);
  part.y = std::max(0.0, (raster.extent.north - north) / cell_y);
  part.width = std::min(px * static_cast<double>(part.pixels.columns) / cell_x,
                        raster.file->GetRasterXSize() - part.x);
  part.height =
      std::min(py * static_cast<double>(part.pixels.rows) / cell_y, raster.file->GetRasterYSize() - part.y);
  return part;
}

bool read_band(GDALRasterBand& band, const Part& part, GDALRIOResampleAlg how, std::vector<float>& into) {
  GDALRasterIOExtraArg extra;
  INIT_RASTERIO_EXTRA_ARG(extra);
  extra.eResampleAlg = how;
  extra.bFloatingPointWindowValidity = TRUE;
  extra.dfXOff = part.x;
  extra.dfYOff = part.y;
  extra.dfXSize = part.width;
  extra.dfYSize = part.height;
  const int x = static_cast<int>(part.x), y = static_cast<int>(part.y);
  const int width = std::max(1, std::min(static_cast<int>(std::ceil(part.width)), band.GetXSize() - x));
  const int height = std::max(1, std::min(static_cast<int>(std::ceil(part.height)), band.GetYSize() - y));
  into.assign(static_cast<std::size_t>(part.pixels.cells()), kNone);
  return band.RasterIO(GF_Read, x, y, width, height, into.data(), static_cast<int>(part.pixels.columns),
                       static_cast<int>(part.pixels.rows), GDT_Float32, 0, 0, &extra) == CE_None;
}

void paint(Relief& relief, const Raster& raster) {
  const Part part = part_of(relief, raster);
  if (part.pixels.cells() <= 0) return;
  GDALRasterBand& band = *raster.file->GetRasterBand(1);
  const bool shrinks = part.width > static_cast<double>(part.pixels.columns);
  const bool large = part.width * part.height > kLargeFile && band.GetOverviewCount() == 0;
  const GDALRIOResampleAlg how = large ? GRIORA_NearestNeighbour : shrinks ? GRIORA_Average : GRIORA_Bilinear;
  std::vector<float> heights;
  if (!read_band(band, part, how, heights)) return;
  int has_nodata = FALSE;
  const double nodata = band.GetNoDataValue(&has_nodata);
  const double scale = band.GetScale(), offset = band.GetOffset();
  for (std::int64_t i = 0; i < part.pixels.cells(); ++i) {
    const float height = heights[static_cast<std::size_t>(i)];
    float& cell = relief.heights(part.pixels.column + i % part.pixels.columns,
                                 part.pixels.row + i / part.pixels.columns);
    const bool missing = !std::isfinite(height) || (has_nodata && height == static_cast<float>(nodata));
    if (!missing && std::isnan(cell)) cell = static_cast<float>(height * scale + offset);
  }
}

Relief blank_relief(const Extent& extent, const Crs& crs, std::int64_t pixels) {
  const GroundScale scale = ground_scale(crs, extent);
  const double width = extent.width() * scale.x, height = extent.height() * scale.y;
  const double pixel = std::max(width, height) / static_cast<double>(pixels);
  const auto count = [&](double length) { return std::max<std::int64_t>(2, std::llround(length / pixel)); };
  Relief relief{extent, Grid<float>(count(width), count(height), kNone)};
  relief.cell_x = width / static_cast<double>(relief.heights.columns());
  relief.cell_y = height / static_cast<double>(relief.heights.rows());
  return relief;
}

}  // namespace

Extent Extent::united(const Extent& other) const {
  return {std::min(west, other.west), std::min(south, other.south), std::max(east, other.east),
          std::max(north, other.north)};
}

Extent Extent::common(const Extent& other) const {
  return {std::max(west, other.west), std::max(south, other.south), std::min(east, other.east),
          std::min(north, other.north)};
}

GroundScale ground_scale(const Crs& crs, const Extent& extent) {
  if (crs.kind() != CrsKind::geographic) return {crs.metres_per_unit(), crs.metres_per_unit()};
  const double degree = crs.body().mean_radius() * kRadiansPerDegree;
  const double latitude = std::min(80.0, std::abs(extent.south + extent.north) / 2);
  return {degree * std::cos(latitude * kRadiansPerDegree), degree};
}

std::optional<Extent> relief_extent(const std::vector<std::string>& names, const Crs& crs, double near_x) {
  const GdalMessages quiet;
  std::optional<Extent> extent;
  for (const Raster& raster : open_rasters(names, crs, near_x))
    extent = extent ? extent->united(raster.extent) : raster.extent;
  return extent;
}

std::int64_t relief_pixels(const std::vector<std::string>& names, const Crs& crs, double near_x,
                           std::int64_t max_pixels) {
  const GdalMessages quiet;
  const std::vector<Raster> rasters = open_rasters(names, crs, near_x);
  if (rasters.empty()) return 0;
  Extent extent = rasters.front().extent;
  double cell_x = extent.width(), cell_y = extent.height();
  for (const Raster& raster : rasters) {
    extent = extent.united(raster.extent);
    cell_x = std::min(cell_x, raster.extent.width() / raster.file->GetRasterXSize());
    cell_y = std::min(cell_y, raster.extent.height() / raster.file->GetRasterYSize());
  }
  const GroundScale scale = ground_scale(crs, extent);
  const bool wide = extent.width() * scale.x >= extent.height() * scale.y;
  const double cells = wide ? extent.width() / cell_x : extent.height() / cell_y;
  return std::clamp<std::int64_t>(std::llround(std::min(cells, 1e9)), 1, max_pixels);
}

std::optional<Relief> read_relief(const std::vector<std::string>& names, const Crs& crs, double near_x,
                                  std::int64_t pixels, const std::optional<Extent>& within) {
  const GdalMessages quiet;
  const std::vector<Raster> rasters = open_rasters(names, crs, near_x);
  if (rasters.empty()) return {};
  Extent extent = rasters.front().extent;
  for (const Raster& raster : rasters) extent = extent.united(raster.extent);
  if (within) extent = extent.common(*within);
  if (!(extent.width() > 0 && extent.height() > 0)) return {};
  Relief relief = blank_relief(extent, crs, pixels);
  for (const Raster& raster : rasters) paint(relief, raster);
  return relief;
}

}  // namespace waymark::exporters
